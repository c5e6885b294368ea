#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "renderer/core/bounds.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// Meshes that several nodes place, stored once: a range of SceneData::meshes.
struct Prototype {
  std::uint32_t first_mesh = 0;
  std::uint32_t mesh_count = 0;
};

/// A prototype placed in the scene: x_scene = x.x axes[0] + x.y axes[1] + x.z axes[2] + at. Where
/// that mirrors, the prototype's triangles wind and its normals point the other way, so that
/// counter-clockwise in the scene is the front.
struct Instance {
  std::array<V3f, 3> axes;  ///< with V3f `at` the columns of a 3x4 matrix, as Embree reads them
  V3f at;                   ///< scene units
  std::uint32_t prototype = 0;
  /// The largest stretch of a length is at most this: the Frobenius norm of the axes.
  float stretch = 1;
  /// A bound on |A| |A^-1| for the matrix A of the axes, in the norm of the largest row sum: how
  /// much the way to the prototype's coordinates and back enlarges a rounding error.
  float condition = 1;
  /// A bound, in scene units, on how far Embree moves a ray when it transforms it to the
  /// prototype's coordinates in single precision; see set_reach().
  float ray_error = 0;

  Instance() = default;
  /// `to_scene`: row vectors; can be inverted.
  Instance(const M44d& to_scene, std::uint32_t prototype);

  /// A point of the prototype in scene coordinates; without rounding but of the result.
  V3f point(const V3f& local) const { return V3f(exact_point(V3d(local))); }
  /// The direction of a normal in scene coordinates, not unit.
  V3f normal(const V3f& local) const {
    return local.x * cross(axes[1], axes[2]) + local.y * cross(axes[2], axes[0]) +
           local.z * cross(axes[0], axes[1]);
  }
  /// The box, in scene coordinates, of the transformed `local` box.
  Bounds bounds(const Bounds& local) const;
  /// Sets `ray_error` for rays from within `reach` of the scene's origin, in every coordinate: four
  /// roundings of products and sums for the origin, and as many for the direction, each of 2^-24 of
  /// the coordinates, enlarged by `condition`.
  void set_reach(float reach) {
    ray_error = 0x1p-21F * condition * (reach + max_abs_component(at));
  }

 private:
  V3d exact_point(const V3d& local) const;
};

inline constexpr std::uint32_t no_instance = std::numeric_limits<std::uint32_t>::max();

}  // namespace lacuna
