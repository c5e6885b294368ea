#pragma once

#include <span>

#include "renderer/core/rng.h"
#include "renderer/materials/gltf_material.h"
#include "renderer/path/counters.h"
#include "renderer/path/vertex.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// How far a walk goes.
struct WalkLimits {
  int max_depth = 1;       ///< edges
  int roulette_depth = 1;  ///< edges that are walked before Russian roulette may end the path
  Transport transport = Transport::radiance;
};

/// Random walk through `scene` from vertex 0 (`path[0]`, whose throughput is set) along `ray`,
/// which was drawn there with density `p`. Each vertex reached is stored in `path` (of at least
/// max_depth + 1) and handed to `visit(depth)`, depth = edges walked, before the walk goes on from
/// it; `before(depth)` is called before the ray to it is traced, for what can be drawn ahead. A
/// guide draws the directions (renderer/guides). The densities of all vertices are per area.
template <class Guide, class Before, class Visit>
void walk(const Scene& scene, Ray ray, Pdf<SolidAngle> p, const Guide& guide,
          const WalkLimits& limits, Rng& rng, std::span<Vertex> path, Counters& counters,
          Before&& before, Visit&& visit) {
  Rgb throughput = path[0].throughput;
  for (int depth = 1; depth <= limits.max_depth; ++depth) {
    const Vertex& from = path[static_cast<std::size_t>(depth) - 1];
    Vertex& v = path[static_cast<std::size_t>(depth)];
    v.delta = false;
    v.wp = -ray.d;
    v.throughput = throughput;
    before(depth);
    Hit hit;
    ++counters.rays;
    if (!scene.rays().intersect(ray, hit)) {
      v.kind = Vertex::Kind::background;
      v.surface.x = ray.d;
      v.p_fwd = to_area(p, from.surface.x, ray.d, v);
      visit(depth);
      return;
    }
    v.kind = Vertex::Kind::surface;
    v.surface = scene.surface(hit);
    v.p_fwd = to_area(p, from.surface.x, ray.d, v);
    const bool last = depth == limits.max_depth;
    if (!last) {
      v.bsdf.emplace(surface_params(scene.material(v.surface), scene.data().textures, v.surface.uv),
                     v.surface.ng, v.surface.ns);
    }
    visit(depth);
    if (last) return;

    const std::optional<BsdfSample> next = guide.sample(v, rng, limits.transport);
    if (!next) return;
    throughput *= next->weight;
    if (depth >= limits.roulette_depth) {
      const float survival = std::min(1.0F, max_component(throughput));
      if (rng.next() >= survival) return;
      throughput /= survival;
    }
    v.delta = next->delta;
    p = next->pdf;
    ray = {offset_origin(v.surface.x, v.surface.ng, v.surface.extent, next->wi), next->wi};
  }
}

}  // namespace lacuna
