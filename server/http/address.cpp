#include "server/http/address.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <stdexcept>

namespace lacuna {
namespace {

struct Address {
  std::string text;
  bool loopback = false;
};

Address parsed_address(const std::string& name) {
  const std::string text = name == "localhost" ? "127.0.0.1" : name;
  in_addr v4{};
  in6_addr v6{};
  if (::inet_pton(AF_INET, text.c_str(), &v4) == 1) return {text, (ntohl(v4.s_addr) >> 24) == 127};
  if (::inet_pton(AF_INET6, text.c_str(), &v6) == 1) return {text, IN6_IS_ADDR_LOOPBACK(&v6) != 0};
  throw std::invalid_argument(fmt::format(
      "\"{}\" is not an address to listen on; allowed: an IP address or localhost", name));
}

}  // namespace

std::string numeric_address(const std::string& name) { return parsed_address(name).text; }

bool is_loopback(const std::string& name) { return parsed_address(name).loopback; }

}  // namespace lacuna
