#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

/// How the service hands jobs to renderers.
struct QueueSettings {
  int children = 1;                   ///< renderers at a time
  int max_attempts = 3;               ///< a renderer that crashes is started this often for one job
  std::size_t max_waiting = 100'000;  ///< jobs that wait or run; more are refused
  std::chrono::milliseconds grace{};  ///< between SIGTERM and SIGKILL
};

/// What the service keeps, and how much room it leaves on the disk.
struct CareSettings {
  std::uint64_t disk_floor = 256 << 20;  ///< bytes; with less free, jobs wait and renderers stop
  std::size_t keep_jobs = 0;             ///< jobs that are over; 0: all
  double keep_days = 0;                  ///< since they ended; 0: for ever
};

/// What a child process is held to, so that the service outlives it and stays quick.
struct ChildLimits {
  /// Of its private writable memory, RLIMIT_DATA; 0: none. Not RLIMIT_AS: that counts address space
  /// too that is only reserved (malloc's arenas, 64 MiB a thread, Embree, TBB) and every library
  /// and file that is mapped, so that it says little of memory and grows with the cores.
  std::uint64_t memory_bytes = 0;
  int niceness = 0;              ///< added to the service's own; the sum is at most 19
  int oom_score_adj = 0;         ///< added to the service's own: the kernel takes the child first
  std::uint64_t file_bytes = 0;  ///< of a file that it writes, RLIMIT_FSIZE; 0: no limit
};

/// How the local executor treats its children.
struct ExecutorSettings {
  std::filesystem::path renderer;             ///< the `lacuna` command
  std::filesystem::path data;                 ///< working directory of the children
  std::filesystem::path cache = {};           ///< of their artefacts; empty: below `data`
  std::vector<std::filesystem::path> scenes;  ///< what they look scenes up in
  std::chrono::milliseconds grace{};          ///< between SIGTERM and SIGKILL
  ChildLimits limits{.niceness = 10, .oom_score_adj = 500};
};

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
  int port = 8017;                                ///< 0: any free one
  std::size_t threads = 160;                      ///< requests that are worked on at a time
  std::size_t waiting = 1024;                     ///< whole requests that wait for a thread
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
