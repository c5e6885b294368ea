#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

/// Watchers of events at a time: each holds a thread.
inline constexpr int max_event_streams = 16;

/// Who may ask.
struct AccessSettings {
  std::filesystem::path token_file;  ///< empty: whoever reaches the address
  std::vector<std::string> hosts;    ///< NAME or NAME:PORT of this service, beside its own address
};

struct HttpSettings {
  std::string bind = "127.0.0.1";
  int port = 8017;  ///< 0: any free one
  /// Connections at a time, each with a thread; others wait in the kernel's line. Fewer where the
  /// process may open few files: set at the service's start.
  std::size_t threads = 1024;
  /// A connection is closed when nothing of a head or body comes for so long, or nothing of an
  /// answer is taken.
  std::chrono::milliseconds silence{5'000};
};

}  // namespace lacuna
