#pragma once

#include <memory>
#include <optional>

#include "jobs/run/run_job.h"
#include "jobs/store/inputs.h"
#include "renderer/integrators/integrator.h"

namespace lacuna {

/// Scene, camera and integrator of a job, ready to render.
struct Prepared {
  std::unique_ptr<ThreadPool> pool;
  std::unique_ptr<Integrator> integrator;  ///< null for a job of `auto` or `foreign`
  std::unique_ptr<Scene> scene;
  std::unique_ptr<Camera> camera;
  std::string camera_name;  ///< of the camera used, also if the job names none
  std::unique_ptr<ArtefactStore> artefacts;
  std::unique_ptr<SpaceAnalysis> space;  ///< no artefact is built yet
  std::string content;                   ///< hashes of the files the picture depends on
  InputList inputs;                      ///< these files, without the reference
  std::vector<std::string> warnings;
};

/// Loads and builds only what `spec` needs. Throws SceneError (no such scene or camera, an invalid
/// asset), InputUnreadable and Stopped.
Prepared prepare(const JobSpec& spec, const RunContext& context);

/// IntegratorSettings' shared_light_paths() for a job's picture.
std::optional<double> light_paths_of_iteration(const JobSpec& spec);

/// Prepares an integrator with the scene and its empty space; only the artefacts that it requests
/// are built, or loaded from the cache. Close `space` after the last integrator. Throws
/// MemoryLimitError, GeometryError, WaitInterrupted, Stopped.
void analyse(const Prepared& prepared, Integrator& integrator);

}  // namespace lacuna
