#include "renderer/guides/arriving_power.h"

namespace lacuna {

namespace {

/// Rays of one part; the parts are summed in order.
constexpr int rays_of_part = 4096;

struct Arrival {
  std::uint32_t part;
  double power;
};

std::vector<Arrival> arrivals(const Scene& scene, const SurfaceLookup& lookup, int first, int end) {
  std::vector<Arrival> all;
  const EmitterSet& lights = scene.emitters();
  for (int i = first; i < end; ++i) {
    Rng rng(0, 0, static_cast<std::uint64_t>(i), Rng::Purpose::integrator);
    const EmitterPoint e = lights.sample(lights.choose(rng), rng);
    const std::optional<Leaving> leaving = lights.sample_first_edge(e, rng);
    Hit hit;
    if (!leaving || !scene.rays().intersect(leaving->ray, hit)) continue;
    const Surface s = scene.surface(hit);
    const std::uint32_t part = lookup.node(V3d(s.x), V3d(s.ng), -V3d(leaving->ray.d));
    const auto power = double(luminance(leaving->throughput));
    if (part != no_node && std::isfinite(power)) all.push_back({part, power});
  }
  return all;
}

}  // namespace

std::vector<double> arriving_power(const Scene& scene, const SurfaceLookup& lookup,
                                   std::size_t count, int rays, const ThreadPool& pool) {
  std::vector<double> power(count, 0.0);
  if (scene.emitters().empty()) return power;
  const int parts = (rays + rays_of_part - 1) / rays_of_part;
  std::vector<std::vector<Arrival>> found(static_cast<std::size_t>(parts));
  pool.for_each(parts, [&](int i) {
    found[static_cast<std::size_t>(i)] =
        arrivals(scene, lookup, i * rays_of_part, std::min(rays, (i + 1) * rays_of_part));
  });
  for (const auto& of_part : found) {
    for (const Arrival& a : of_part) power[a.part] += a.power / rays;
  }
  return power;
}

}  // namespace lacuna
