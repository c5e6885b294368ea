#include "jobs/run/prepare.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/scene/close_surfaces.h"
#include "renderer/scene/delta_surfaces.h"
#include "renderer/scene/hidden_emitters.h"
#include "renderer/scene/material_change.h"
#include "renderer/scene/nested_solids.h"
#include "renderer/scene/particles.h"
#include "renderer/scene/points_in_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <numbers>

#include "base/storage/available_memory.h"
#include "base/storage/passing_error.h"
#include "jobs/run/choice.h"
#include "renderer/scene/scene_shape.h"

namespace lacuna {

namespace {

std::filesystem::path resolve(const RunContext& context, const std::string& what,
                              const std::string& name,
                              const std::vector<std::string_view>& extensions) {
  try {
    return context.scenes.resolve(name, extensions);
  } catch (const std::invalid_argument& e) {
    throw SceneError(fmt::format("{} \"{}\": {}", what, name, e.what()));
  }
}

/// The parts of the scene that a job of this integrator needs.
SceneNeeds needs_of(const JobSpec& spec, const Integrator& integrator) {
  SceneNeeds needs = integrator.needs();
  if (std::ranges::find(spec.layers, LayerRequest(ImageLayer::albedo)) != spec.layers.end()) {
    needs.materials = true;
  }
  if (light_paths_of_iteration(spec)) needs.light_tree = true;  // for unreached_emitters()
  return needs;
}

/// The parts of the scene that any candidate of a job of `auto` needs.
SceneNeeds needs_of_candidates(const JobSpec& spec) {
  SceneNeeds all;
  for (const Candidate& c : new_choice(spec).candidates) {
    const JobSpec job = candidate_job(spec, c);
    const SceneNeeds one = needs_of(job, *make_integrator(method_of(job.integrator)));
    all.materials |= one.materials;
    all.emission |= one.emission;
    all.space |= one.space;
    all.light_tree |= one.light_tree;
  }
  return all;
}

/// Measures the job's environment file.
InputFile measure_environment(const std::string& name, const std::filesystem::path& file) {
  try {
    InputFile measured = measure_input(file);
    measured.role = InputRole::environment;
    measured.name = name;
    return measured;
  } catch (const std::invalid_argument& e) {
    throw SceneError(fmt::format("{} {}", file.string(), e.what()));
  }
}

/// Sets up the analysis of the scene's empty space around the job's camera, without building it.
void set_up_analysis(Prepared& p, const JobSpec& spec, const RunContext& context,
                     const CameraData& camera) {
  Observer& observer = context.observer;
  p.artefacts = std::make_unique<ArtefactStore>(StoreSettings{
      .folder = context.data.cache(),
      .byte_limit = context.data.cache_limit,
      .label = spec.scene,
      .message = [&observer](const std::string& line) { observer.milestone(line); },
      .warning = [&observer](const std::string& line) { observer.warning(line); },
      .building = [&observer](const std::string& type) { observer.milestone("building " + type); },
      .interrupted = context.interrupted});
  const SceneData& data = p.scene->data();
  p.space = std::make_unique<SpaceAnalysis>(
      SpaceInput{.triangles = [&data] { return triangle_soup(data); },
                 .geometry = geometry_key(data),
                 .seeds =
                     [&data, camera, everywhere = spec.environment.has_value()] {
                       return domain_seeds(data, camera, everywhere);
                     },
                 .settings = spec.analysis,
                 .byte_limit = memory_to_take},
      *p.artefacts, *p.pool);
}

/// Warnings before rendering.
std::vector<std::string> warnings_of(const Scene& scene, const Camera& camera,
                                     const JobIntegrator& integrator, const ThreadPool& pool) {
  std::vector<std::string> all = close_surfaces(scene, pool);
  if (!scene.has_emitters()) return all;
  const auto add = [&all](std::vector<std::string> warnings) {
    for (std::string& w : warnings) all.push_back(std::move(w));
  };
  if (scene.emitters().empty()) {
    all.emplace_back(
        "the scene has no light: the picture is black; the job's `environment` adds one: "
        "{\"file\": \"sky.hdr\"}");
  }
  add(hidden_emitters(scene));
  add(lights_in_surfaces(scene));
  add(nested_solids(scene));
  add(camera_in_solid(scene, camera));
  if (from_lights_only(integrator)) add(missing_reflections(scene, camera));
  return all;
}

}  // namespace

std::optional<double> light_paths_of_iteration(const JobSpec& spec) {
  return shared_light_paths(spec.integrator,
                            double(spec.resolution[0]) * double(spec.resolution[1]));
}

Prepared prepare(const JobSpec& spec, const RunContext& context) {
  Prepared p;
  p.pool = std::make_unique<ThreadPool>(context.threads >= 0 ? context.threads : spec.threads,
                                        context.interrupted);
  if (!context.trace.empty()) p.pool->log().keep_spans();
  const WorkSection section(*p.pool, "load");
  const bool chooses = std::holds_alternative<AutoSettings>(spec.integrator);
  const bool foreign = std::holds_alternative<ForeignSettings>(spec.integrator);
  if (!chooses && !foreign) p.integrator = make_integrator(method_of(spec.integrator));
  SceneData data = load_gltf(resolve(context, "scene", spec.scene, scene_extensions), &p.inputs,
                             {spec.time, spec.animation, spec.variant, spec.light_units});
  p.inputs.front().name = spec.scene;
  if (spec.material) change_material(data, *spec.material, spec.scene);
  if (spec.particles) add_particles(data, *spec.particles);
  CameraData camera = spec.camera.object ? look_at(*spec.camera.object, data.origin)
                                         : choose_camera(data, spec.camera.name, spec.scene);
  p.camera_name = camera.name;
  p.warnings = data.warnings;
  if (biased(spec.integrator)) {
    p.warnings.emplace_back(
        consistent(spec.integrator)
            ? "each iteration is biased by its radius: the error vanishes as the radius shrinks, "
              "but is not bounded by the noise"
            : "the integrator's settings make it biased: an error remains for any render time");
  }
  p.content = fmt::format("{:016x}", data.content_hash);

  SceneNeeds needs;
  if (chooses) {
    needs = needs_of_candidates(spec);
  } else if (!foreign) {
    needs = needs_of(spec, *p.integrator);
  }
  if (spec.environment && data.environment) {
    p.warnings.emplace_back(
        "the file's EXT_lights_image_based is left out: the job names an environment");
  }
  std::optional<EnvironmentImage> environment;
  if (spec.environment && needs.emission) {
    const auto& e = *spec.environment;
    environment = {resolve(context, "environment", e.file, environment_extensions),
                   static_cast<float>(e.scale),
                   static_cast<float>(e.rotation * std::numbers::pi / 180)};
    p.inputs.push_back(measure_environment(e.file, environment->file));
    p.content += fmt::format("-{}", p.inputs.back().hash);
  }
  p.scene = std::make_unique<Scene>(std::move(data), needs, environment, *p.pool);
  if (environment &&
      measure_environment(spec.environment->file, environment->file) != p.inputs.back()) {
    throw InputUnreadable(EAGAIN,
                          fmt::format("{} changed while it was read", environment->file.string()));
  }
  const auto contact = leave_surfaces(camera, *p.scene);
  std::optional<Crop> crop;
  if (const auto& c = spec.crop) crop = Crop{{c->from[0], c->from[1]}, {c->of[0], c->of[1]}};
  p.camera = std::make_unique<Camera>(camera, spec.resolution[0], spec.resolution[1],
                                      spec.pixel_filter, crop);
  for (std::string& w : warnings_of(*p.scene, *p.camera, spec.integrator, *p.pool)) {
    p.warnings.push_back(std::move(w));
  }
  if (contact) {
    for (std::string& w : look_back(*p.camera, *contact, *p.scene)) {
      p.warnings.push_back(std::move(w));
    }
  }
  set_up_analysis(p, spec, context, camera);
  return p;
}

void analyse(const Prepared& p, Integrator& integrator) {
  const WorkSection section(*p.pool, "prepare");
  integrator.prepare({.scene = *p.scene, .pool = *p.pool, .space = *p.space, .camera = *p.camera});
}

}  // namespace lacuna
