#include "server/listener.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cerrno>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace lacuna {
namespace {

constexpr int backlog = 512;
constexpr int send_buffer = 256 * 1024;

struct Address {
  sockaddr_storage storage{};
  socklen_t length = 0;
};

Address parse(const std::string& name, int port) {
  const std::string literal = name == "localhost" ? "127.0.0.1" : name;
  Address result;
  auto* v4 = reinterpret_cast<sockaddr_in*>(&result.storage);
  auto* v6 = reinterpret_cast<sockaddr_in6*>(&result.storage);
  if (::inet_pton(AF_INET, literal.c_str(), &v4->sin_addr) == 1) {
    v4->sin_family = AF_INET;
    v4->sin_port = htons(static_cast<std::uint16_t>(port));
    result.length = sizeof *v4;
  } else if (::inet_pton(AF_INET6, literal.c_str(), &v6->sin6_addr) == 1) {
    v6->sin6_family = AF_INET6;
    v6->sin6_port = htons(static_cast<std::uint16_t>(port));
    result.length = sizeof *v6;
  } else {
    throw std::invalid_argument(
        fmt::format("\"{}\" is no address to bind to: give an IP address or localhost", name));
  }
  return result;
}

}  // namespace

bool is_loopback(const std::string& address) {
  const Address a = parse(address, 0);
  if (a.storage.ss_family == AF_INET6) {
    const auto* v6 = reinterpret_cast<const sockaddr_in6*>(&a.storage);
    return IN6_IS_ADDR_LOOPBACK(&v6->sin6_addr);
  }
  const auto* v4 = reinterpret_cast<const sockaddr_in*>(&a.storage);
  return (ntohl(v4->sin_addr.s_addr) >> 24) == 127;
}

Listener::Listener(const std::string& address, int port) {
  const Address wanted = parse(address, port);
  const auto check = [&](int result) {
    if (result < 0) {
      throw std::system_error(errno, std::generic_category(),
                              fmt::format("cannot listen on {} port {}", address, port));
    }
  };
  socket_ =
      FileHandle(::socket(wanted.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  check(socket_.get());
  const int yes = 1;  // a restart need not wait for old connections to be forgotten
  check(::setsockopt(fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes));
  check(::bind(fd(), reinterpret_cast<const sockaddr*>(&wanted.storage), wanted.length));
  check(::listen(fd(), backlog));

  Address bound;
  bound.length = sizeof bound.storage;
  check(::getsockname(fd(), reinterpret_cast<sockaddr*>(&bound.storage), &bound.length));
  const bool is_v6 = bound.storage.ss_family == AF_INET6;
  port_ = ntohs(is_v6 ? reinterpret_cast<sockaddr_in6*>(&bound.storage)->sin6_port
                      : reinterpret_cast<sockaddr_in*>(&bound.storage)->sin_port);
  host_ = is_v6 ? "[" + address + "]" : address;
}

std::string Listener::url() const { return fmt::format("http://{}:{}/", host_, port_); }

FileHandle Listener::accept() const {
  FileHandle connection(::accept4(fd(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (connection) {
    const int yes = 1;  // answers and events are written whole: nothing to wait for
    ::setsockopt(connection.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    // Else clients that take nothing could each hold megabytes of the kernel's memory.
    ::setsockopt(connection.get(), SOL_SOCKET, SO_SNDBUF, &send_buffer, sizeof send_buffer);
  }
  return connection;
}

}  // namespace lacuna
