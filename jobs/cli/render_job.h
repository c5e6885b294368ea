#pragma once

#include <filesystem>

#include "jobs/run/merge_shards.h"

namespace lacuna {

struct RenderOptions {
  int threads = -1;  ///< -1: the job's own number; 0: one per core
  bool quiet = false;
  std::filesystem::path trace;                 ///< file for the work of all threads; empty: none
  const std::vector<Shard>* shards = nullptr;  ///< the job is merged from these, not rendered
};

/// Makes the next rendering of the job start from the first iteration; keeps its pictures until
/// then. Throws FolderBusy.
void start_again(const JobFolder& folder);

/// Renders a job's folder, resuming from its checkpoint, shows progress, and returns the exit code.
int render_folder(const JobFolder& folder, const RenderOptions& options);

}  // namespace lacuna
