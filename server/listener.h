#pragma once

#include <string>

#include "analysis/storage/file_handle.h"

namespace lacuna {

/// An address literal or `localhost` that only this machine can reach.
bool is_loopback(const std::string& address);

/// A listening TCP socket.
class Listener {
 public:
  /// Throws std::system_error, naming the address, if it cannot be had; `port` 0: any free one.
  Listener(const std::string& address, int port);

  int fd() const { return socket_.get(); }
  int port() const { return port_; }
  /// "http://127.0.0.1:8017/"
  std::string url() const;
  /// The next connection, non-blocking and closed in child processes; empty if there is none (any
  /// more), with errno saying why.
  FileHandle accept() const;

 private:
  FileHandle socket_;
  std::string host_;
  int port_ = 0;
};

}  // namespace lacuna
