#include "jobs/run/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/version.h"
#include "renderer/film/half_layers.h"
#include "renderer/film/preview.h"
#include "renderer/images/exr_write.h"

namespace lacuna {

namespace {

const std::vector<std::string> rgb{"R", "G", "B"};

/// A layer of the first hit: the mean over a few iterations of integrator `inspect`.
std::vector<double> first_hit(const RenderTask& task, InspectQuantity quantity) {
  constexpr std::uint64_t iterations = 16;
  const auto inspect = make_integrator(InspectSettings{quantity});
  Film film(task.spec.resolution[0], task.spec.resolution[1]);
  const std::function<bool()> never = [] { return false; };
  for (std::uint64_t i = 0; i < iterations; ++i) {
    Image frame(film.width(), film.height());
    inspect->iterate({task.scene, task.camera, task.pool, task.spec.seed, i, never}, frame);
    film.add(i, frame, &task.pool);
  }
  return film.mean();
}

std::vector<double> every_third(const std::vector<double>& values) {
  std::vector<double> result;
  result.reserve(values.size() / 3);
  for (std::size_t i = 0; i < values.size(); i += 3) result.push_back(values[i]);
  return result;
}

/// The power of two by which variances are multiplied in a file of `type`. Squares of radiances
/// leave a float's range long before the radiances do; then, and always in halves, the largest is
/// scaled to near 1.
double variance_scale(const std::vector<double>& variance, PixelType type) {
  const double largest = *std::max_element(variance.begin(), variance.end());
  const bool fits = type == PixelType::single_float && largest > 0x1p-80 && largest < 0x1p100;
  return largest == 0 || fits ? 1 : std::exp2(-std::ilogb(largest));
}

void add_layer(const RenderTask& task, const Film& film, ImageLayer layer,
               std::vector<ExrLayer>& out) {
  switch (layer) {
    case ImageLayer::variance:
      out.push_back({"variance", rgb,
                     independent_iterations(task.spec) ? film.variance_of_mean()
                                                       : film.variance_from_halves()});
      return;
    case ImageLayer::halves:
      out.push_back({"even", rgb, film.half_mean(0)});
      out.push_back({"odd", rgb, film.half_mean(1)});
      return;
    case ImageLayer::albedo:
      out.push_back({"albedo", rgb, first_hit(task, InspectQuantity::albedo)});
      return;
    case ImageLayer::normal:
      out.push_back({"normal", {"X", "Y", "Z"}, first_hit(task, InspectQuantity::normal)});
      return;
    case ImageLayer::depth:
      out.push_back({"depth", {"Z"}, every_third(first_hit(task, InspectQuantity::depth))});
      return;
    case ImageLayer::strategies:
    case ImageLayer::strategies_unweighted:
    case ImageLayer::distributions:
    case ImageLayer::visibility_tests:
    case ImageLayer::negative:
    case ImageLayer::lengths:
      return;  // filled by each iteration (RenderLoop::layers())
  }
}

/// Scales the layer `variance`, and records the scale in the file's attributes.
void scale_variance(std::vector<ExrLayer>& layers, PixelType type,
                    std::map<std::string, std::string>& attributes) {
  for (ExrLayer& layer : layers) {
    if (layer.name != "variance") continue;
    const double scale = variance_scale(layer.values, type);
    for (double& v : layer.values) v *= scale;
    attributes[std::string(variance_scale_attribute)] = fmt::format("{:.17g}", scale);
  }
}

std::map<std::string, std::string> attributes(const RenderTask& task, const RenderLoop& loop) {
  std::map<std::string, std::string> a{
      {"version", version()},
      {"job", task.folder.id()},
      {"spec", write_job(task.spec)},
      {"seed", fmt::format("{}", task.spec.seed)},
      {"iterations", fmt::format("{}", loop.spent().iterations)},
      {"seconds", fmt::format("{:.3f}", loop.spent().seconds)},
      {"cpu_seconds", fmt::format("{:.3f}", loop.spent().cpu_seconds)},
      {"scene_hash", fmt::format("{:016x}", task.scene.data().content_hash)},
  };
  for (const LightPathsLayer& l : light_paths_layers(task.spec.layers)) {
    a[fmt::format("light.{}", l.name)] = l.light;
  }
  if (const auto rmse = estimated_rmse(loop.film())) a["est_rmse"] = fmt::format("{:.17g}", *rmse);
  return a;
}

/// Writes layers.half, then its index layers.json.
void write_half_layers(const JobFolder& folder, const ExrPicture& picture,
                       const std::function<void()>& between) {
  AtomicFile file(folder.file("layers.half"));
  ByteWriter out([&](std::string_view piece) {
    file.write(piece);
    between();
  });
  const std::vector<HalfLayer> entries = pack_half(picture.layers, out);
  out.flush();
  file.commit();
  OrderedJson index;
  index["width"] = picture.width;
  index["height"] = picture.height;
  for (const HalfLayer& l : entries) {
    index["layers"].push_back({{"name", l.name},
                               {"channels", l.channels},
                               {"offset", l.offset},
                               {"bytes", l.bytes},
                               {"scale", l.scale}});
  }
  write_file_atomically(folder.file("layers.json"), document_text(index));
}

}  // namespace

void write_pictures(const JobFolder& folder, ExrPicture picture, const Reference* reference,
                    const std::function<void()>& between) {
  if (reference != nullptr) picture.layers.push_back({"reference", rgb, {}, reference->rgb});
  write_half_layers(folder, picture, between);
  if (reference != nullptr) picture.layers.pop_back();
  write_preview(folder.file("image.png"), picture.width, picture.height,
                picture.layers.front().values);
  scale_variance(picture.layers, picture.type, picture.attributes);
  write_exr(folder.file("image.exr"), picture, between);
}

void write_results(const RenderTask& task, const RenderLoop& loop) {
  const Film& film = loop.film();
  std::vector<ExrLayer> layers{{"", rgb, film.mean()}};
  for (const ImageLayer layer : named_layers(task.spec.layers)) {
    add_layer(task, film, layer, layers);
    task.stop_if_late();
  }
  const LayerMeans& own = loop.layers();
  for (std::size_t i = 0; i < own.names().size(); ++i) {
    layers.push_back({own.names()[i], rgb, {}, own.sum(i), own.divisor()});
  }
  write_pictures(task.folder,
                 {film.width(), film.height(), std::move(layers), task.spec.pixel_type,
                  attributes(task, loop)},
                 task.reference, [&] { task.stop_if_late(); });
  write_file_atomically(task.folder.file("curve.csv"), loop.curve().csv());
}

}  // namespace lacuna
