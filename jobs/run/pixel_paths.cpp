#include "jobs/run/pixel_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "jobs/run/run_state.h"
#include "jobs/spec/problems.h"

namespace lacuna {
namespace {

/// Integrators whose paths an observer sees whole.
template <class S>
constexpr bool is_traced = std::is_same_v<S, PathSettings> || std::is_same_v<S, LightSettings> ||
                           std::is_same_v<S, BdptSettings>;

void check(const JobSpec& spec, const std::array<int, 2>& pixel, std::uint64_t samples) {
  std::vector<Problem> problems;
  const std::string_view reason = without_traces(spec.integrator);
  if (!reason.empty()) {
    const auto name = std::visit([](const auto& s) { return s.name; }, spec.integrator);
    problems.push_back({"/integrator", fmt::format("found \"{}\", which {}", name, reason)});
  }
  for (std::size_t k = 0; k < 2; ++k) {
    if (pixel[k] >= 0 && pixel[k] < spec.resolution[k]) continue;
    problems.push_back(
        {"", fmt::format("--pixel: found {} {}; allowed: 0 to {}", k == 0 ? "column" : "row",
                         pixel[k], spec.resolution[k] - 1)});
  }
  const Budget budget = budget_of(spec);
  if (budget.iterations && samples > static_cast<std::uint64_t>(*budget.iterations)) {
    problems.push_back({"", fmt::format("--samples: found {}; allowed: 1 to {}, the iterations of "
                                        "the job",
                                        samples, *budget.iterations)});
  }
  if (!problems.empty()) throw BadJob(std::move(problems));
}

OrderedJson vector_json(const V3d& x) { return {x.x, x.y, x.z}; }

OrderedJson vertex_json(const TracedVertex& v, const V3d& origin) {
  const V3d x = V3d(v.x) + (v.infinite ? V3d(0) : origin);
  return {{v.infinite ? "direction" : "position", vector_json(x)},
          {"from", v.from_light ? "light" : "eye"},
          {"density", v.density}};
}

}  // namespace

std::string_view without_traces(const JobIntegrator& integrator) {
  return std::visit(
      []<class S>(const S& s) -> std::string_view {
        if constexpr (!is_traced<S>) {
          return "does not keep whole paths; allowed: \"path\", \"light\", \"bdpt\"";
        }
        if constexpr (std::is_same_v<S, PathSettings>) {
          if (s.reuse > 1) {
            return "adds the ends of paths to other pixels, too (\"reuse\"); allowed: reuse 1";
          }
        }
        if constexpr (std::is_same_v<S, BdptSettings>) {
          if (!std::holds_alternative<PairedSettings>(s.connections)) {
            return "keeps light vertices without the paths to them; allowed: connections "
                   "\"paired\"";
          }
        }
        return {};
      },
      integrator);
}

PixelPaths trace_pixel(const JobSpec& spec, const Prepared& prepared,
                       const std::array<int, 2>& pixel, std::uint64_t samples,
                       const std::function<bool()>& stop) {
  check(spec, pixel, samples);
  PixelPaths found{pixel, samples, spec.seed, V3d(0), {}};
  RunState state(spec, {}, std::numeric_limits<std::uint64_t>::max());  // of the render
  Image image(spec.resolution[0], spec.resolution[1]);
  PathObserver observer(static_cast<std::uint32_t>(image.index(pixel[0], pixel[1])));
  for (std::uint64_t k = 0; k < samples; ++k, state.done.add_next()) {
    std::ranges::fill(image.pixels, Rgb(0, 0, 0));
    prepared.integrator->iterate({.scene = *prepared.scene,
                                  .camera = *prepared.camera,
                                  .pool = *prepared.pool,
                                  .seed = spec.seed,
                                  .iteration = state.done.next(),
                                  .stop = stop,
                                  .sampler = spec.sampler,
                                  .observer = &observer},
                                 image);
    found.mean += V3d(image.at(pixel[0], pixel[1])) / double(samples);
    std::ranges::move(observer.take(), std::back_inserter(found.paths));
  }
  std::ranges::stable_sort(found.paths, std::ranges::greater{},
                           [](const TracedPath& p) { return luminance(p.value); });
  return found;
}

OrderedJson pixel_paths_json(const PixelPaths& found, const SceneData& scene,
                             std::size_t brightest) {
  const Bounds box = scene.bounds();
  double all = 0;
  for (const TracedPath& p : found.paths) all += double(luminance(p.value));
  OrderedJson list = OrderedJson::array();
  for (const TracedPath& p : found.paths) {
    if (list.size() == brightest) break;
    OrderedJson vertices = OrderedJson::array();
    for (const TracedVertex& v : p.vertices) vertices.push_back(vertex_json(v, scene.origin));
    list.push_back({{"iteration", p.iteration},
                    {"s", p.s},
                    {"t", p.t},
                    {"letters", p.letters},
                    {"value", vector_json(V3d(p.value))},
                    {"share", all > 0 ? double(luminance(p.value)) / all : 0.0},
                    {"weight", p.weight},
                    {"vertices", std::move(vertices)}});
  }
  return {{"pixel", found.pixel},
          {"samples", found.samples},
          {"seed", found.seed},
          {"mean", vector_json(found.mean)},
          {"bounds", {vector_json(box.low + scene.origin), vector_json(box.high + scene.origin)}},
          {"count", found.paths.size()},
          {"paths", std::move(list)}};
}

}  // namespace lacuna
