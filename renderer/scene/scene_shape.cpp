#include "renderer/scene/scene_shape.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/geometry/alpha_mask.h"

namespace lacuna {
namespace {

/// Adds a triangle's centre and points near its corners: a large light may illuminate several
/// rooms.
void add_emitter(DomainSeeds& seeds, const std::array<V3d, 3>& corners, bool both_sides) {
  const V3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const V3d centre = (corners[0] + corners[1] + corners[2]) / 3;
  constexpr double inwards = 0.1;
  for (const V3d& p : {centre, centre * inwards + corners[0] * (1 - inwards),
                       centre * inwards + corners[1] * (1 - inwards),
                       centre * inwards + corners[2] * (1 - inwards)}) {
    seeds.points.push_back({p, n});
    if (both_sides) seeds.points.push_back({p, -n});
  }
}

/// Appends the triangles of meshes.
void append(std::span<const Mesh> meshes, std::vector<V3f>& positions,
            std::vector<TriangleSoup::Triangle>& triangles) {
  std::size_t vertices = 0, count = 0;
  for (const Mesh& m : meshes) {
    vertices += m.positions.size();
    count += m.triangles.size();
  }
  positions.reserve(vertices);
  triangles.reserve(count);
  for (const Mesh& m : meshes) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), m.positions.begin(), m.positions.end());
    for (const auto& t : m.triangles) {
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
}

}  // namespace

TriangleSoup triangle_soup(const SceneData& scene) {
  TriangleSoup soup;
  append(scene.placed_meshes(), soup.positions, soup.triangles);
  for (const Prototype& p : scene.prototypes) {
    auto& [positions, triangles] = soup.prototypes.emplace_back();
    append(scene.meshes_of(p), positions, triangles);
  }
  for (const Instance& i : scene.instances) soup.place({i.prototype, i.axes, i.at});
  return soup;
}

std::string geometry_key(const SceneData& scene) {
  return fmt::format("{:016x}", scene.geometry_hash);
}

std::string occluder_key(const SceneData& scene) {
  const bool masked = std::any_of(scene.meshes.begin(), scene.meshes.end(),
                                  [&](const Mesh& m) { return AlphaMask::needed(scene, m); });
  return masked ? fmt::format("{:016x}", scene.content_hash) : geometry_key(scene);
}

DomainSeeds domain_seeds(const SceneData& scene, const CameraData& camera, bool environment) {
  DomainSeeds seeds;
  seeds.points.push_back({camera.to_world.translation(), std::nullopt});
  for (const Mesh& m : scene.meshes) {
    const Material& material = scene.materials[m.material];
    if (!material.emits()) continue;
    for (const auto& t : m.triangles) {
      add_emitter(seeds, {V3d(m.positions[t[0]]), V3d(m.positions[t[1]]), V3d(m.positions[t[2]])},
                  material.emits_behind());
    }
  }
  seeds.from_infinity = environment || scene.environment;
  for (const PunctualLight& light : scene.lights) {
    if (light.kind == PunctualLight::Kind::directional) {
      seeds.from_infinity = true;
    } else {
      seeds.points.push_back({V3d(light.position), std::nullopt});
    }
  }
  return seeds;
}

}  // namespace lacuna
