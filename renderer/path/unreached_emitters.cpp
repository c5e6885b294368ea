#include "renderer/path/unreached_emitters.h"

#include <fmt/format.h>

#include "renderer/path/connect.h"
#include "renderer/path/guide.h"
#include "renderer/path/next_event.h"

namespace lacuna {

namespace {

constexpr int across = 32, emitters_each = 16;

/// The direct light at a point.
struct Direct {
  double light = 0;         ///< sum of c_i
  double by_paths = 0;      ///< sum of c_i^2 / p_i
  double most = 0;          ///< of the terms of by_paths
  std::uint32_t entry = 0;  ///< the emitter of that term

  double paths_of(double paths) const { return paths * light * light / by_paths; }
};

Direct direct_light(const Scene& scene, const Vertex& v, Rng rng) {
  const NextEvent next_event(scene, EmitterChoice::tree);
  const Guide guide;
  const SurfaceEndpoint eye{v, 1, Transport::radiance, guide};
  Direct d;
  for (int k = 0; k < emitters_each; ++k) {
    const EmitterPoint e = next_event.sample(v, {}, rng);
    const EmitterEndpoint light{e, guide};
    const Connection c = connect(eye, light);
    if (!c || scene.rays().occluded(shadow_ray(eye, light, c))) continue;
    // c_i over the density of this selection, which is next_event_ratio times p_i.
    const auto value = double(luminance(c.contribution)) / emitters_each;
    const double term = value * value * emitters_each * double(e.next_event_ratio);
    d.light += value;
    d.by_paths += term;
    if (term <= d.most) continue;
    d.most = term;
    d.entry = e.entry;
  }
  return d;
}

}  // namespace

std::vector<std::string> unreached_emitters(const Scene& scene, const Camera& camera,
                                            double paths) {
  if (scene.emitters().empty()) return {};
  int lit = 0, unreached = 0;
  std::string first;
  for (int i = 0; i < across * across; ++i) {
    const auto at = [](int k, int size) {
      return (static_cast<float>(k) + 0.5F) / across * static_cast<float>(size);
    };
    const Ray ray = camera.ray(at(i % across, camera.width()), at(i / across, camera.height()));
    Hit hit;
    if (!scene.rays().intersect(ray, hit)) continue;
    Vertex v;
    v.kind = Vertex::Kind::surface;
    v.surface = scene.surface(ray, hit);
    v.wp = -ray.d;
    scene.make_bsdf(v.surface, v.bsdf);
    if (!v.bsdf->connectible()) continue;
    const Direct d = direct_light(scene, v, Rng(0, 0, std::uint64_t(i), Rng::Purpose::gather));
    if (!(d.by_paths > 0)) continue;
    ++lit;
    if (d.paths_of(paths) >= 1) continue;
    if (unreached++ == 0) first = scene.emitters().name(d.entry);
  }
  // A few points beside an emitter are always lit by a small part of it.
  constexpr double some = 1.0 / 64;
  if (unreached == 0 || unreached < some * lit) return {};
  return {fmt::format(
      "{:.2g} % of what the camera sees is lit by emitters, the first \"{}\", that {:.0f} light "
      "paths in all are expected to reach less than once: it is too dark or noisy there; more "
      "`light_paths` or iterations reach them",
      100.0 * unreached / lit, first, paths)};
}

}  // namespace lacuna
