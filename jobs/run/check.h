#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/parallel/thread_pool.h"
#include "jobs/run/run_job.h"
#include "renderer/core/bounds.h"
#include "renderer/gltf/gltf_features.h"
#include "renderer/gltf/gltf_load.h"

namespace lacuna {

/// Loads everything that the job needs and throws the exceptions of run_job(), without rendering.
/// Returns warnings.
std::vector<std::string> check_job(const JobSpec& spec, const RunContext& context);

/// The contents of a scene.
struct SceneCounts {
  std::size_t triangles = 0, materials = 0, textures = 0, cameras = 0, lights = 0;
  Bounds box;  ///< of all triangles, in the coordinates of the file
  std::vector<std::string> warnings;
  std::vector<FeatureUse> features;  ///< what of glTF the file uses
  /// Its first 16 cameras, each as the job's object that has the same view.
  std::vector<std::string> views;
};

/// Loads a scene and builds everything that a job can need of it. Throws SceneError as a job would.
SceneCounts check_scene(const std::filesystem::path& file, const SceneChoice& choice,
                        const ThreadPool& pool);

}  // namespace lacuna
