#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/parallel/thread_pool.h"
#include "renderer/core/vec.h"
#include "renderer/geometry/scene_data.h"

struct RTCSceneTy;

namespace lacuna {

/// A ray or, with a finite `tmax`, a segment: x = o + t d. `d` need not be unit.
struct alignas(32) Ray {
  V3f o;
  V3f d;
  float tmax = std::numeric_limits<float>::infinity();
};

/// The triangle that a ray hits, and the point on it: x = (1 - u - v) p0 + u p1 + v p2, in the
/// coordinates of its mesh.
struct Hit {
  float t = 0;
  std::uint32_t mesh = 0;
  std::uint32_t triangle = 0;
  float u = 0, v = 0;
  std::uint32_t instance = no_instance;  ///< index into SceneData::instances, if `mesh` is of one
};

/// A traced ray, for benchmarks that trace the same rays through Embree directly.
struct RecordedRay {
  Ray ray;
  bool shadow;  ///< an occlusion query
};

/// The only class that calls Embree. Watertight ("robust") traversal by AVX2 kernels, bit-identical
/// for any number of threads. Embree aborts the process on rays that are not finite; this class
/// rejects and counts them.
class RayCaster {
 public:
  /// Shares the triangles of `scene` with Embree, those of prototypes once, and keeps a pointer to
  /// it. Makes room behind each mesh's positions. Masked points below the cutoff are not hit, and
  /// points of alphaMode BLEND with probability alpha, independently for each ray. Only meshes
  /// whose alpha can be below 1 get a filter. Builds with the thread count of `pool`. Throws
  /// SceneError, std::bad_alloc if Embree runs out of memory, and Stopped.
  RayCaster(SceneData& scene, const ThreadPool& pool);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// Finds the nearest hit in (0, tmax]; false if there is none.
  bool intersect(const Ray& ray, Hit& hit) const;
  /// intersect() for coherent rays, such as rays from one origin through neighbouring texels, in
  /// packets of eight. All spans have one element per ray; `result` is 1 for a hit.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits,
                 std::span<std::uint8_t> result) const;
  /// Whether the ray hits anything in (0, tmax].
  bool occluded(const Ray& ray) const;
  /// occluded() for many rays; `result` has one element per ray, 1 if occluded.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> result) const;

  /// occluded() for rays from one origin to neighbouring points, in packets of eight.
  void occluded_together(std::span<const Ray> rays, std::span<std::uint8_t> result) const;

  /// Appends every traced ray to `rays` from now on, in order; null stops. Requires that a single
  /// thread traces rays.
  void record(std::vector<RecordedRay>* rays) const;

  std::uint64_t refused_rays() const;  ///< not finite, or of a magnitude beyond Embree's range
  int filters() const;                 ///< geometries with an alpha-mask filter
  std::uint64_t bytes() const;         ///< memory held by Embree
  RTCSceneTy* embree_scene() const;    ///< for benchmarks that call Embree directly

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lacuna
