#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

/// Maximum open event streams, each of which holds a thread.
inline constexpr int max_event_streams = 16;

/// Which clients are admitted.
struct AccessSettings {
  std::filesystem::path token_file;  ///< empty: every client that reaches the address
  std::vector<std::string> hosts;    ///< NAME or NAME:PORT of this service, besides its address
};

struct HttpSettings {
  std::string bind = "127.0.0.1";
  int port = 8017;  ///< 0: any free one
  /// Maximum connections, each with a thread; others wait in the kernel's queue. The service
  /// reduces it at the start if the process may open few files.
  std::size_t threads = 1024;
  /// Timeout after which a connection is closed if no part of a head or body arrives, or no part of
  /// a response is read.
  std::chrono::milliseconds silence{5'000};
};

}  // namespace lacuna
