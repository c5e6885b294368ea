#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

/// Settings of the queue.
struct QueueSettings {
  int children = 1;                   ///< renderers at a time
  int max_attempts = 3;               ///< a renderer that crashes is started this often for one job
  std::size_t max_waiting = 100'000;  ///< jobs that wait or run; more are refused
  std::chrono::milliseconds grace{};  ///< between SIGTERM and SIGKILL
  bool lasting = true;  ///< the database outlives the process: folders say what made them
};

/// Limits of a child process, so that its parent survives it and stays responsive.
struct ChildLimits {
  /// Of its private writable memory, RLIMIT_DATA; 0: none. Not RLIMIT_AS: that counts address space
  /// too that is only reserved (malloc's arenas, 64 MiB a thread, Embree, TBB) and every library
  /// and file that is mapped, so that it says little of memory and grows with the cores.
  std::uint64_t memory_bytes = 0;
  int niceness = 0;              ///< added to the parent's own; the sum is at most 19
  int oom_score_adj = 0;         ///< added to the parent's own: the kernel takes the child first
  std::uint64_t file_bytes = 0;  ///< of a file that it writes, RLIMIT_FSIZE; 0: no limit
};

/// What every executor knows of its renderers.
struct ExecutorSettings {
  std::filesystem::path renderer;             ///< the `lacuna` command
  std::vector<std::string> options = {};      ///< further ones of `lacuna render`
  std::filesystem::path directory;            ///< working directory of the children
  std::filesystem::path data;                 ///< root of the data
  std::filesystem::path cache = {};           ///< of their artefacts; empty: below `data`
  std::vector<std::filesystem::path> scenes;  ///< what they look scenes up in
  std::chrono::milliseconds grace{};          ///< between SIGTERM and SIGKILL
  ChildLimits limits{.niceness = 10, .oom_score_adj = 500};
};

}  // namespace lacuna
