#pragma once

#include <filesystem>

#include "jobs/run/merge_shards.h"

namespace lacuna {

struct RenderOptions {
  int threads = -1;  ///< -1: the job's own number; 0: one per core
  bool quiet = false;
  const std::vector<Shard>* shards = nullptr;  ///< the job is merged from these, not rendered
};

/// Makes the job begin anew the next time it is rendered; its pictures stay until then. Throws
/// FolderBusy.
void start_again(const JobFolder& folder);

/// Renders a job's folder from where it stands, shows its progress, and returns the exit code.
int render_folder(const JobFolder& folder, const RenderOptions& options);

}  // namespace lacuna
