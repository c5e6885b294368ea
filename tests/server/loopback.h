#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <string>
#include <string_view>
#include <vector>

#include "server/http/http.h"

namespace lacuna::test {

/// A connection to a server of this process.
class Client {
 public:
  Client(const HttpServer& server, std::string_view text)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const std::string url = server.url();
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1))));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    send(text);
  }
  void send(std::string_view text) const {
    ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// What comes until it holds `end`, or until the server closes.
  std::string read(std::string_view end = "") const {
    std::string text;
    std::vector<char> buffer(1 << 20);
    while (end.empty() || text.find(end) == std::string::npos) {
      const ssize_t n = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
      if (n <= 0) break;
      text.append(buffer.data(), static_cast<std::size_t>(n));
    }
    return text;
  }
  /// Of the next answer: waits for its first line.
  int status() const {
    const std::string text = read("\r\n");
    return text.size() > 12 ? std::stoi(text.substr(9, 3)) : 0;
  }

 private:
  FileHandle socket_;
};

/// A head after whose answer the server closes.
inline std::string head(const std::string& line, const std::string& more = "") {
  return line + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + more + "\r\n";
}

}  // namespace lacuna::test
