#include "renderer/gltf/gltf_origin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/gltf/gltf_primitives.h"
#include "renderer/gltf/gltf_vertices.h"

namespace lacuna::gltf {
namespace {

/// Bounds of the finite vertices that the triangles of a primitive use: in the mesh's coordinates,
/// or in the world's.
Bounds posed_bounds(const Source& source, const Vertices& vertices, bool in_world) {
  Bounds box;
  const auto used =
      used_vertices(source.model, source.primitive(), vertices.size(), source.place());
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    if (const V3f x(in_world ? vertices.world(v) : vertices.local(v)); is_finite(x)) box.add(x);
  }
  return box;
}

Bounds scene_bounds(const file::Model& model, const std::vector<PlacedNode>& nodes,
                    const Skins& skins) {
  std::vector<std::vector<std::optional<Bounds>>> local(model.meshes.size());
  Bounds box;
  for (const PlacedNode& node : nodes) {
    const auto mesh = mesh_of(model, node);
    if (!mesh) continue;
    local[*mesh].resize(model.meshes[*mesh].primitives.size());
    for (std::size_t i = 0; i < local[*mesh].size(); ++i) {
      const Source source{model, *mesh, i, node, skins};
      if (!is_drawn(source.primitive()) || source.hidden()) continue;
      auto& own = local[*mesh][i];
      const auto add_own = [&] {
        if (own->empty()) return;
        box.add(own->with_corners_moved([&](const V3d& p) { return p * node.to_world; }));
      };
      if (own && !node.skin && node.weights.empty()) {
        add_own();
        continue;
      }
      const Vertices vertices(source);
      if (!vertices.rigid()) {
        box.add(posed_bounds(source, vertices, true));
        continue;
      }
      if (!own) own = posed_bounds(source, vertices, false);
      add_own();
    }
  }
  return box;
}

double longest(const V3d& size) { return std::max({size.x, size.y, size.z}); }

constexpr double too_far = 0x1p14;

}  // namespace

V3d scene_origin(const file::Model& model, const std::vector<PlacedNode>& nodes,
                 const Skins& skins) {
  constexpr double far = 32;
  const Bounds box = scene_bounds(model, nodes, skins);
  const double side = longest(box.size());
  const V3d centre = (box.low + box.high) / 2;
  const double distance = longest({std::abs(centre.x), std::abs(centre.y), std::abs(centre.z)});
  if (!(side > 0) || !std::isfinite(distance) || !(distance > far * side)) return V3d(0.0);
  const double grid = std::exp2(std::floor(std::log2(side)));
  return {std::round(centre.x / grid) * grid, std::round(centre.y / grid) * grid,
          std::round(centre.z / grid) * grid};
}

bool is_far_for_its_size(const Bounds& box) {
  double largest = 0;
  for (int k = 0; k < 3; ++k) {
    largest = std::max({largest, std::abs(box.low[k]), std::abs(box.high[k])});
  }
  return !box.empty() && largest > too_far * longest(box.size());
}

void warn_of_places(const SceneData& scene, std::uint64_t coarse, Warnings& warnings) {
  std::uint64_t count = 0;
  double worst = 0;
  std::string which;
  for (const Mesh& mesh : scene.meshes) {
    Bounds box;
    for (const V3f& p : mesh.positions) box.add(p);
    if (!is_far_for_its_size(box)) continue;
    ++count;
    const V3d centre = (box.low + box.high) / 2;
    const double size = longest(box.size());
    if (const double ratio = centre.length() / size; ratio > worst) {
      worst = ratio;
      which = fmt::format("\"{}\" is {:.2g} wide at a distance of {:.2g}", mesh.name, size,
                          centre.length());
    }
  }
  if (count > 0) {
    warnings.once(fmt::format(
        "{} of {} meshes are too small for their distance from the middle of the scene, of which "
        "floats resolve 2^-24: light in and around them may be wrong ({})",
        count, scene.meshes.size(), which));
  }
  if (coarse > 0) {
    warnings.once(fmt::format(
        "{} of {} meshes have coordinates in the file that are more than {} times their size: "
        "floats do not resolve their shape; a node's translation would",
        coarse, scene.meshes.size(), too_far));
  }
}

void warn_of_far_cameras(const SceneData& scene, Warnings& warnings) {
  const double side = longest(scene.bounds().size());
  for (const CameraData& camera : scene.cameras) {
    const double distance = camera.to_world.translation().length();
    if (!(distance > too_far * side)) continue;
    warnings.once(
        fmt::format("camera \"{}\" is {:.2g} from the middle of a scene {:.2g} wide: its place is "
                    "rounded by {:.1g}",
                    camera.name, distance, side, distance * 0x1p-24));
  }
}

}  // namespace lacuna::gltf
