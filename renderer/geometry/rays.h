#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/geometry/scene_data.h"

struct RTCSceneTy;

namespace lacuna {

/// A ray or, with a finite `tmax`, a segment. `d` need not be unit; t counts in multiples of it.
struct alignas(32) Ray {
  V3f o;
  V3f d;
  float tmax = std::numeric_limits<float>::infinity();
};

/// Which triangle a ray meets, and where: x = (1 - u - v) p0 + u p1 + v p2.
struct Hit {
  float t = 0;
  std::uint32_t mesh = 0;
  std::uint32_t triangle = 0;
  float u = 0, v = 0;
};

/// A ray that was sent, for benchmarks that send the same ones bare.
struct RecordedRay {
  Ray ray;
  bool shadow;  ///< only whether anything is met was asked
};

/// The one place where Embree is called. Watertight ("robust") traversal on AVX2 kernels, the same
/// bits for any number of threads. Embree aborts the process on rays that are not finite: they are
/// refused here and counted.
class RayCaster {
 public:
  /// Copies the triangles of `scene` and keeps a pointer to its materials and textures for alpha
  /// masks: a hit where alpha < cutoff is no hit. Only geometries whose material has a mask get a
  /// filter. Builds with `threads` threads. Throws SceneError, and std::bad_alloc if Embree runs
  /// out of memory.
  RayCaster(const SceneData& scene, int threads);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// Nearest hit in (0, tmax], false if there is none.
  bool intersect(const Ray& ray, Hit& hit) const;
  /// Whether anything lies in (0, tmax].
  bool occluded(const Ray& ray) const;
  /// The same for many rays at once; `result` has as many places, 1: occluded.
  void occluded(std::span<const Ray> rays, std::span<std::uint8_t> result) const;

  /// From now on adds every ray to `rays`, in the order they are sent; null: no longer. Only where
  /// one thread sends them.
  void record(std::vector<RecordedRay>* rays) const;

  std::uint64_t refused_rays() const;  ///< not finite, or of a magnitude beyond Embree's range
  int filters() const;                 ///< geometries with an alpha-mask filter
  std::uint64_t bytes() const;         ///< memory held by Embree
  RTCSceneTy* embree_scene() const;    ///< for benchmarks that send bare rays

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lacuna
