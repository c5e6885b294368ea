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

/// Bounds that keep one client from using up the service (FACTS, section 4).
struct HttpSettings {
  std::string bind = "127.0.0.1";
  int port = 8017;             ///< 0: any free one
  std::size_t threads = 160;   ///< requests that are worked on at a time
  std::size_t waiting = 1024;  ///< whole requests that wait for a thread
  /// Of this process: with one above it a connection is dropped, the oldest first; the rest is kept
  /// for the service's own files. Set at its start.
  int max_connection_fd = 1 << 20;
  std::size_t parked = 1024;                      ///< connections whose request is still coming
  std::size_t reading_bytes = 64 << 20;           ///< of answers to slow readers, all together
  std::chrono::milliseconds head_time{5'000};     ///< to send the head of a request
  std::chrono::milliseconds body_time{15'000};    ///< to send its body; a large one:
  std::size_t body_bytes = 1 << 20;               ///< this much of it, again and again
  std::chrono::milliseconds answer_time{15'000};  ///< in which a slow reader has to take
  std::size_t answer_bytes = 1 << 20;             ///< this much of a long answer, again and again

  /// Threads that may wait for a client at a time. Event streams have threads, too; what is left,
  /// at least 16 where there are threads enough, never waits for one.
  std::size_t slow_seats() const {
    constexpr std::size_t kept_free = max_event_streams + 16;
    return threads > kept_free ? threads - kept_free : 1;
  }
};

}  // namespace lacuna
