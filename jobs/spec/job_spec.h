#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/settings/analysis_settings.h"
#include "base/settings/field.h"
#include "jobs/spec/job_integrator.h"
#include "jobs/spec/name_or_object.h"
#include "renderer/settings/camera_settings.h"
#include "renderer/settings/error_metrics.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/sampler.h"
#include "renderer/settings/scene_settings.h"

namespace lacuna {

/// budget.error: stop when the picture is good enough.
struct ErrorTarget {
  ErrorMetric metric = ErrorMetric::est_rmse;
  double target = 0;
  bool operator==(const ErrorTarget&) const = default;
};
template <class V>
void describe(V& v, ErrorTarget& s) {
  v("metric", s.metric,
    {.doc = "the error metric; all but est_rmse need a reference", .required = true});
  v("target", s.target,
    {.doc = "stop when the error is at or below this",
     .min = 0,
     .above_min = true,
     .required = true});
}

/// When to stop: the first limit reached ends the job. With no limit at all, 60 seconds.
struct Budget {
  static constexpr double default_seconds = 60;
  std::optional<double> seconds;
  std::optional<double> cpu_seconds;
  std::optional<std::int64_t> iterations;
  std::optional<ErrorTarget> error;
  bool operator==(const Budget&) const = default;
};
template <class V>
void describe(V& v, Budget& s) {
  v("seconds", s.seconds,
    {.doc = "render time, wall clock", .min = 0, .max = 1e7, .above_min = true, .unit = "s"});
  v("cpu_seconds", s.cpu_seconds,
    {.doc = "render time, CPU seconds divided by threads: independent of other load on the machine",
     .min = 0,
     .max = 1e7,
     .above_min = true,
     .unit = "s"});
  v("iterations", s.iterations,
    {.doc = "iterations, each an estimate of the whole image", .min = 1, .max = 4294967295.0});
  v("error", s.error, {.doc = "stop when the error has reached a target"});
}

/// An environment light, from an equirectangular image.
struct EnvironmentSettings {
  std::string file;
  double scale = 1;
  double rotation = 0;
  bool operator==(const EnvironmentSettings&) const = default;
};
template <class V>
void describe(V& v, EnvironmentSettings& s) {
  v("file", s.file,
    {.doc = "equirectangular EXR or HDR, below a scenes root; its centre is along -z, y is up",
     .min = 1,
     .max = 1024,
     .required = true});
  v("scale", s.scale, {.doc = "factor of its radiance", .min = 0, .max = 1e12});
  v("rotation", s.rotation,
    {.doc = "rotation about the y axis, counter-clockwise from above",
     .min = -360,
     .max = 360,
     .unit = "degrees"});
}

/// A part of a larger picture.
struct CropSettings {
  std::array<int, 2> of{0, 0};
  std::array<int, 2> from{0, 0};
  bool operator==(const CropSettings&) const = default;
};
template <class V>
void describe(V& v, CropSettings& s) {
  v("of", s.of,
    {.doc = "width and height of the larger picture",
     .min = 1,
     .max = 65536,
     .required = true,
     .unit = "pixels"});
  v("from", s.from,
    {.doc = "column and row in the larger picture, from the upper left, at which the crop begins",
     .min = 0,
     .max = 65535,
     .unit = "pixels"});
}

/// Shards of a job, at most.
inline constexpr int max_shards = 1 << 16;

/// An element of a job's `layers`.
using LayerRequest = WordOr<ImageLayer, LightPathsLayer>;

/// The layers that are named by a word, and those of expressions.
inline std::vector<ImageLayer> named_layers(const std::vector<LayerRequest>& all) {
  std::vector<ImageLayer> named;
  for (const LayerRequest& l : all) {
    if (!l.object) named.push_back(l.word);
  }
  return named;
}
inline std::vector<LightPathsLayer> light_paths_layers(const std::vector<LayerRequest>& all) {
  std::vector<LightPathsLayer> layers;
  for (const LayerRequest& l : all) {
    if (l.object) layers.push_back(*l.object);
  }
  return layers;
}

/// One job, as posted to the service or passed to `lacuna render`.
struct JobSpec {
  std::string scene;
  std::optional<double> time;
  std::string animation;
  std::string variant;
  LightUnits light_units = LightUnits::file;
  NameOr<CameraSettings> camera;
  std::string label;
  std::array<int, 2> resolution{512, 512};
  std::optional<CropSettings> crop;
  JobIntegrator integrator;
  Budget budget;
  std::string reference;
  int reference_iterations = 1024;
  AnalysisSettings analysis;
  std::optional<EnvironmentSettings> environment;
  std::optional<ParticleSettings> particles;
  std::optional<MaterialChange> material;
  std::uint64_t seed = 1;
  Sampler sampler = Sampler::sobol;
  int shards = 1;
  int shard = 0;
  int threads = 0;
  std::vector<LayerRequest> layers;
  PixelFilter pixel_filter = PixelFilter::box;
  PixelType pixel_type = PixelType::single_float;
  double checkpoint_seconds = 10;
  bool exclusive = false;
  bool operator==(const JobSpec&) const = default;
};
/// Whether the iterations of a job are independent; otherwise its two halves are.
inline bool independent_iterations(const JobSpec& s) {
  return s.sampler == Sampler::independent || !spreads_samples(s.integrator);
}
template <class V>
void describe(V& v, JobSpec& s) {
  v("scene", s.scene,
    {.doc = "glTF or GLB file, below a scenes root", .min = 1, .max = 1024, .required = true});
  v("time", s.time,
    {.doc = "moment of the scene's animations; none: its static pose",
     .min = 0,
     .max = 1e7,
     .unit = "s"});
  v("animation", s.animation,
    {.doc = "name of the only animation that `time` shows; empty: all of them", .max = 1024});
  v("variant", s.variant,
    {.doc = "name of one of the file's material variants (KHR_materials_variants); empty: the "
            "materials that meshes have without one",
     .max = 1024});
  v("light_units", s.light_units, {.doc = "what the numbers of the file's punctual lights are"});
  v("camera", s.camera,
    {.doc = "name of one of the scene's cameras, or position and direction of another camera; "
            "empty: the scene's first",
     .max = 1024});
  v("label", s.label, {.doc = "a description of your own", .max = 200});
  v("resolution", s.resolution,
    {.doc = "width and height", .min = 1, .max = 16384, .unit = "pixels"});
  v("crop", s.crop, {.doc = "render only a part, of size `resolution`, of a larger picture"});
  v("integrator", s.integrator, {.doc = "the rendering method"});
  v("budget", s.budget,
    {.doc = "when to stop; the first limit reached ends the job; none: 60 seconds"});
  v("reference", s.reference,
    {.doc = "the picture that errors are measured against: a stored reference's name, a job id, an "
            "EXR, Radiance HDR, PFM or TIFF of floats below a scenes root, or \"auto\" (rendered "
            "once, as two "
            "independent halves, and stored); empty: none",
     .max = 1024});
  v("reference_iterations", s.reference_iterations,
    {.doc = "iterations of an \"auto\" reference, both halves together",
     .min = 2,
     .max = 100000000});
  v("analysis", s.analysis,
    {.doc = "shape analysis of the empty space, computed only if the integrator uses it"});
  v("environment", s.environment, {.doc = "environment light"});
  v("particles", s.particles, {.doc = "point lights in addition to those of the scene"});
  v("material", s.material, {.doc = "change the roughness of one of the scene's materials"});
  v("seed", s.seed, {.doc = "seed of the random numbers", .min = 0, .max = 9007199254740991.0});
  v("sampler", s.sampler,
    {.doc = "random numbers of eye paths and light paths", .published = "\"independent\""});
  v("shards", s.shards,
    {.doc = "number of parts of the iterations that are rendered separately and merged",
     .min = 1,
     .max = max_shards});
  v("shard", s.shard,
    {.doc = "render only this part, 1 to `shards`; 0: all iterations",
     .min = 0,
     .max = max_shards});
  v("threads", s.threads, {.doc = "number of threads; 0: one per core", .min = 0, .max = 1024});
  v("layers", s.layers,
    {.doc = "additional layers of image.exr: names, of which some need a method that has them, and "
            "objects for the light whose paths match an expression, at most 8",
     .max = 16});
  v("pixel_filter", s.pixel_filter, {.doc = "reconstruction filter of a pixel"});
  v("pixel_type", s.pixel_type, {.doc = "precision of image.exr"});
  v("checkpoint_seconds", s.checkpoint_seconds,
    {.doc = "time between checkpoints; longer if writing one is slow",
     .min = 0.05,
     .max = 86400,
     .unit = "s"});
  v("exclusive", s.exclusive,
    {.doc = "run alone: the service renders no other job at the same time, so that measured times "
            "are valid"});
}

}  // namespace lacuna
