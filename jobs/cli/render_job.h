#pragma once

#include <filesystem>

#include "jobs/store/job_folder.h"

namespace lacuna {

struct RenderOptions {
  int threads = -1;  ///< -1: the job's own number; 0: one per core
  bool quiet = false;
};

/// Renders a job's folder from where it stands, shows its progress, and returns the exit code.
int render_folder(const JobFolder& folder, const RenderOptions& options);

}  // namespace lacuna
