#include "renderer/guides/arriving_power.h"

#include <algorithm>

namespace lacuna {

namespace {

/// Rays per task; the results of tasks are summed in order.
constexpr int rays_of_part = 4096;

struct Arrival {
  std::uint32_t part;
  double power;
};
/// A ray and the power along it.
struct EmittedRay {
  Ray ray;
  double power;
};

/// Where the emitters emit a sampled ray from, and the ray.
struct Emission {
  EmitterPoint from;
  EmittedRay along;
};

/// None where a sample has no density.
std::optional<Emission> emitted(const EmitterSet& lights, Rng& rng) {
  const EmitterPoint e = lights.sample(lights.choose(rng));
  const std::optional<LightLeSample> le = lights.sample_Le(e, rng);
  if (!le) return std::nullopt;
  return Emission{e, {le->ray, double(luminance(le->throughput))}};
}

/// `emit(rng)` returns a ray with its power, or none.
template <class Emit>
std::vector<double> arriving(const Scene& scene, const SurfaceLookup& lookup, std::size_t count,
                             int rays, const ThreadPool& pool, const Emit& emit) {
  const int parts = (rays + rays_of_part - 1) / rays_of_part;
  std::vector<std::vector<Arrival>> arrivals(static_cast<std::size_t>(parts));
  pool.for_each(parts, [&](int part) {
    const int first = part * rays_of_part, end = std::min(rays, first + rays_of_part);
    for (int i = first; i < end; ++i) {
      Rng rng(0, 0, static_cast<std::uint64_t>(i), Rng::Purpose::arriving_power);
      const std::optional<EmittedRay> emitted = emit(rng);
      Hit hit;
      if (!emitted || !scene.rays().intersect(emitted->ray, hit)) continue;
      const Surface s = scene.surface(emitted->ray, hit);
      const std::uint32_t node = lookup.node(V3d(s.x), V3d(s.ng), -V3d(emitted->ray.d));
      if (node != no_node && std::isfinite(emitted->power)) {
        arrivals[static_cast<std::size_t>(part)].push_back({node, emitted->power});
      }
    }
  });
  std::vector<double> power(count, 0.0);
  for (const auto& of_part : arrivals) {
    for (const Arrival& a : of_part) power[a.part] += a.power / rays;
  }
  return power;
}

}  // namespace

std::vector<double> arriving_power(const Scene& scene, const SurfaceLookup& lookup,
                                   std::size_t count, int rays, const ThreadPool& pool) {
  const EmitterSet& lights = scene.emitters();
  if (lights.empty()) return std::vector<double>(count, 0.0);
  return arriving(scene, lookup, count, rays, pool, [&](Rng& rng) -> std::optional<EmittedRay> {
    const auto e = emitted(lights, rng);
    return e ? std::optional(e->along) : std::nullopt;
  });
}

std::uint32_t brightest_part(const Scene& scene, const SurfaceLookup& lookup, std::size_t count,
                             int rays, const ThreadPool& pool) {
  const EmitterSet& lights = scene.emitters();
  std::vector<double> power(count, 0.0);
  bool any = false;
  for (int i = 0; i < rays && !lights.empty(); ++i) {
    Rng rng(0, 0, static_cast<std::uint64_t>(i), Rng::Purpose::arriving_power);
    const auto e = emitted(lights, rng);
    if (!e || e->from.infinite()) continue;
    const V3d w(e->along.ray.d);
    const V3d n = e->from.kind == EmitterPoint::Kind::area ? V3d(e->from.ng) : w;
    const std::uint32_t part = lookup.node(V3d(e->from.x), n, w);
    if (part == no_node || !std::isfinite(e->along.power)) continue;
    power[part] += e->along.power;
    any = true;
  }
  if (!any) power = arriving_power(scene, lookup, count, rays, pool);
  return static_cast<std::uint32_t>(std::max_element(power.begin(), power.end()) - power.begin());
}

std::vector<double> arriving_importance(const Scene& scene, const Camera& camera,
                                        const SurfaceLookup& lookup, std::size_t count, int rays,
                                        const ThreadPool& pool) {
  return arriving(scene, lookup, count, rays, pool, [&](Rng& rng) -> std::optional<EmittedRay> {
    const V2f at = rng.next2();
    return EmittedRay{camera.ray(at.x * static_cast<float>(camera.width()),
                                 at.y * static_cast<float>(camera.height())),
                      1.0};
  });
}

}  // namespace lacuna
