#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/parallel/thread_pool.h"
#include "jobs/run/run_job.h"

namespace lacuna {

/// Loads all that the job needs and throws what run_job would, without rendering. Returns warnings.
std::vector<std::string> check_job(const JobSpec& spec, const RunContext& context);

/// What a scene holds.
struct SceneCounts {
  std::size_t triangles = 0, materials = 0, textures = 0, cameras = 0, lights = 0;
  std::vector<std::string> warnings;
};

/// Loads a scene and builds all that any job could ask of it. Throws SceneError where a job would.
SceneCounts check_scene(const std::filesystem::path& file, const ThreadPool& pool);

}  // namespace lacuna
