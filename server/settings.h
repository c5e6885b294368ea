#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

/// How the service hands jobs to renderers.
struct QueueSettings {
  int children = 1;      ///< renderers at a time
  int max_attempts = 3;  ///< a renderer that crashes is started this often for one job
};

/// How the local executor treats its children.
struct ExecutorSettings {
  std::filesystem::path renderer;             ///< the `lacuna` command
  std::filesystem::path data;                 ///< working directory of the children
  std::vector<std::filesystem::path> scenes;  ///< what they look scenes up in
  std::chrono::milliseconds grace{};          ///< between SIGTERM and SIGKILL
};

/// Bounds that keep one client from using up the service (FACTS, section 4).
struct HttpSettings {
  std::string bind = "127.0.0.1";
  int port = 8017;                                ///< 0: any free one
  std::size_t threads = 64;                       ///< requests at a time
  std::size_t waiting = 256;                      ///< connections that wait for a thread
  std::chrono::milliseconds head_time{5'000};     ///< to send the head of a request
  std::chrono::milliseconds body_time{15'000};    ///< to send its body
  std::chrono::milliseconds answer_time{15'000};  ///< in which a slow reader has to take
  std::size_t answer_bytes = 1 << 20;             ///< this much of a long answer, again and again
};

/// Watchers of events at a time: each holds a thread.
inline constexpr int max_event_streams = 16;

}  // namespace lacuna
