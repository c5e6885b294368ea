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
  int max_attempts = 3;               ///< renderers started for one job if they crash
  std::size_t max_waiting = 100'000;  ///< jobs that wait or run; further ones are refused
  std::chrono::milliseconds grace{};  ///< between SIGTERM and SIGKILL
  bool lasting = true;  ///< the database outlives the process: writes accepted.json into folders
};

/// Limits of a child process, so that its parent survives it and stays responsive.
struct ChildLimits {
  /// Of its private writable memory, RLIMIT_DATA; 0: none. Not RLIMIT_AS, which also counts
  /// reserved address space (malloc's arenas, 64 MiB per thread, Embree, TBB) and every mapped
  /// library and file: it is a poor measure of memory and grows with the number of cores.
  std::uint64_t memory_bytes = 0;
  int niceness = 0;              ///< added to the parent's; the sum is at most 19
  int oom_score_adj = 0;         ///< added to the parent's: the kernel kills the child first
  std::uint64_t file_bytes = 0;  ///< of a file that it writes, RLIMIT_FSIZE; 0: no limit
};

/// Settings of renderers, for every executor.
struct ExecutorSettings {
  std::filesystem::path renderer;             ///< the `lacuna` command
  std::vector<std::string> options = {};      ///< further options of `lacuna render`
  std::filesystem::path directory;            ///< working directory of the children
  std::filesystem::path data;                 ///< root of the data
  std::filesystem::path cache = {};           ///< of artefacts; empty: below `data`
  std::vector<std::filesystem::path> scenes;  ///< scenes roots
  std::chrono::milliseconds grace{};          ///< between SIGTERM and SIGKILL
  ChildLimits limits{.niceness = 10, .oom_score_adj = 500};
};

}  // namespace lacuna
