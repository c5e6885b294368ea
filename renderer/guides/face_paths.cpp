#include "renderer/guides/face_paths.h"

#include "renderer/path/direct_light.h"
#include "renderer/path/emitter_selection.h"
#include "renderer/path/shadow_queue.h"
#include "renderer/path/tiles.h"

namespace lacuna {

namespace {

/// Traces the paths of a batch and adds what they find to `light`.
class PathsFromFaces {
 public:
  PathsFromFaces(const IterationContext& context, int edges, Counters& counters)
      : context_(context),
        edges_(edges),
        counters_(counters),
        direct_(context.scene, bsdf_, true, EmitterChoice::automatic),
        batch_(edges),
        selection_(direct_.next_event(), direct_.active(), edges, batch_),
        walk_(context.scene, bsdf_, {.max_depth = edges, .roulette_depth = edges}, counters) {}

  void start(const Ray& ray, const Rng& rng) {
    const std::span<Vertex> path =
        std::span(batch_.vertices).subspan(batch_.states.size() * batch_.stride, batch_.stride);
    path[0].kind = Vertex::Kind::eye;
    path[0].surface.x = ray.o;
    // No other technique samples the first edge: its density has no effect.
    batch_.states.push_back({.rng = rng, .ray = ray, .p = Pdf<SolidAngle>(1.0F), .path = path});
  }

  void trace(std::span<float> light) {
    ShadowQueue<Found> shadows;
    walk_.trace_paths(
        batch_.states,
        [&](std::size_t i, int depth) {
          const Vertex& v = batch_.vertex(i, depth);
          light[i] += luminance(direct_.hit(v, batch_.vertex(i, depth - 1), depth));
          if (v.kind != Vertex::Kind::surface || depth == edges_ || !direct_.active()) return;
          if (!v.bsdf->connectible()) return;
          direct_.sample(v, depth, selection_.of(i), batch_.states[i].rng,
                         [&](const Ray& ray, const Rgb& value, const DirectLight::Sample&) {
                           shadows.add(ray, {i, luminance(value)});
                         });
        },
        selection_);
    shadows.flush(context_.scene.rays(), counters_,
                  [&](const Found& found) { light[found.path] += found.light; });
  }

 private:
  struct Found {
    std::size_t path;
    float light;
  };

  const IterationContext& context_;
  int edges_;
  Counters& counters_;
  Guide bsdf_;
  DirectLight direct_;
  EyeBatch batch_;
  EmitterSelection selection_;
  Walk walk_;
};

}  // namespace

Counters arriving_light(const IterationContext& context, int edges,
                        const std::function<Ray(std::size_t, Rng&)>& ray, std::span<float> light) {
  constexpr std::size_t together = EyeBatch::size;
  const auto parts = static_cast<int>((light.size() + together - 1) / together);
  return for_each_part(context, parts, [&](int part, Counters& counters) {
    PathsFromFaces paths(context, edges, counters);
    const std::size_t first = static_cast<std::size_t>(part) * together;
    const std::size_t n = std::min(together, light.size() - first);
    for (std::size_t i = first; i < first + n; ++i) {
      Rng rng(context.seed, context.iteration, i, Rng::Purpose::face_paths);
      const Ray start = ray(i, rng);
      paths.start(start, rng);
    }
    paths.trace(light.subspan(first, n));
  });
}

}  // namespace lacuna
