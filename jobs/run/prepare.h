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
  std::unique_ptr<Integrator> integrator;  ///< null: the job is of `auto` (Choosing)
  std::unique_ptr<Scene> scene;
  std::unique_ptr<Camera> camera;
  std::string camera_name;  ///< of the camera that was chosen, also where the job names none
  std::unique_ptr<ArtefactStore> artefacts;
  std::unique_ptr<SpaceAnalysis> space;  ///< nothing of it is built yet
  std::string content;                   ///< hashes of the files the picture depends on
  InputList inputs;                      ///< these files; the reference is not among them
  std::vector<std::string> warnings;
};

/// Loads and builds what `spec` needs, and only that. Throws SceneError: no such scene or camera,
/// an asset that cannot be used; InputUnreadable; and Stopped.
Prepared prepare(const JobSpec& spec, const RunContext& context);

/// IntegratorSettings' shared_light_paths() for a job's picture.
std::optional<double> light_paths_of_iteration(const JobSpec& spec);

/// Lets an integrator look at the scene and at its empty space; only what it asks for is built, or
/// loaded from the cache. After the last one `space` is to be closed. Throws MemoryLimitError,
/// GeometryError, WaitInterrupted, Stopped.
void analyse(const Prepared& prepared, Integrator& integrator);

}  // namespace lacuna
