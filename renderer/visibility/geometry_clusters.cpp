#include "renderer/visibility/geometry_clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/path/tile.h"

namespace lacuna {

namespace {

/// Quantised depth, normal and visibility cluster of a point (Olsson et al. 2012): slices of depth
/// are as thick as a tile is wide, and normals have 3 x 3 cells on each face of a cube.
struct ClusterKey {
  std::uint32_t cluster;
  int slice, face, u, v;
  auto operator<=>(const ClusterKey&) const = default;

  ClusterKey(const ShadingPoint& p, std::uint32_t visibility_cluster, const Camera& camera,
             double tile)
      : cluster(visibility_cluster) {
    const V3f x = p.vertex->surface.x;
    const double depth = double((x - camera.eye(x)).length());
    const double at = camera.parallel() ? depth / tile : std::log(depth) / std::log1p(tile);
    slice = static_cast<int>(std::clamp(std::floor(at), -1e9, 1e9));
    const V3f n = p.vertex->side();
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
    }
    const auto cell = [&](int k) {
      return static_cast<int>(std::floor((n[(axis + k) % 3] / std::abs(n[axis]) + 1) * 1.5F));
    };
    face = 2 * axis + (n[axis] < 0 ? 1 : 0);
    u = cell(1), v = cell(2);
  }
};

}  // namespace

GeometryClusters::GeometryClusters(std::span<const ShadingPoint> points,
                                   std::span<const std::uint32_t> cluster, const Camera& camera,
                                   GateTestCounts& counts, std::vector<std::uint32_t>& of_point)
    : counts_(counts) {
  const double tile = Tile::block_side * camera.pixel_side(camera.forward(), 1);
  std::vector<std::pair<ClusterKey, std::size_t>> keys;
  for (std::size_t i = 0; i < points.size(); ++i) {
    keys.emplace_back(ClusterKey(points[i], cluster[i], camera, tile), i);
  }
  std::sort(keys.begin(), keys.end());
  of_point.resize(points.size());
  for (std::size_t first = 0, end = 0; first < keys.size(); first = end) {
    V3f low(std::numeric_limits<float>::infinity()), high = -low;
    for (; end < keys.size() && keys[end].first == keys[first].first; ++end) {
      of_point[keys[end].second] = static_cast<std::uint32_t>(clusters.size());
      const V3f x = points[keys[end].second].vertex->surface.x;
      for (int k = 0; k < 3; ++k)
        low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
    }
    const V3f centre = (low + high) * 0.5F;
    const float size = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z),
                                 std::abs(high.x), std::abs(high.y), std::abs(high.z)});
    constexpr float rounding = 1e-6F;
    clusters.push_back({centre, (high - low).length() * 0.5F * (1 + rounding) + size * rounding});
  }
}

GeometryClusters::~GeometryClusters() {
  counts_.clusters += clusters.size();
  counts_.spheres += sphere_tests;
  counts_.points += point_tests;
  counts_.all += all_tests;
}

unsigned cone_meets(const Float8x3& to_gate, float gate_radius2, const Float8x3& to_centre,
                    float radius) {
  const Float8 d2 = length2(to_gate);
  const Float8 sine2 = Float8(gate_radius2) / d2;
  const Float8 s2 = length2(to_centre);
  const Float8 along = dot(to_centre, to_gate) / sqrt(d2);
  const Float8 across = sqrt(max(Float8(0.0F), s2 - along * along));
  // The distance of the centre from the surface of the cone, at most.
  const Float8 off = across * sqrt(max(Float8(0.0F), Float8(1.0F) - sine2)) - along * sqrt(sine2);
  constexpr float rounding = 1e-3F;  // of across, where the centre is near the axis
  const Float8 least = Float8(radius) + sqrt(s2) * rounding;
  // Also where the light is within the gate's sphere, or a number is not finite.
  return (movemask(off > least) ^ 0xff) | movemask(sine2 > Float8(1.0F));
}

}  // namespace lacuna
