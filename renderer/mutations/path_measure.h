#pragma once

#include "renderer/mutations/whole_path.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// The contribution of whole paths, and the densities of sampling their vertices from the eye and
/// from the light. The scene and the camera must outlive this.
class PathMeasure {
 public:
  PathMeasure(const Scene& scene, const Camera& camera);

  /// Computes edges, film position and contribution of `path` from its nodes, as if all edges were
  /// visible. Returns false if it is black or outside the film.
  bool evaluate(WholePath& path, const VertexPool& pool) const;

  /// Density of sampling x_i, 1 <= i <= k, from x_{i-1} in direction from the eye.
  double from_eye(const WholePath& path, const VertexPool& pool, int i) const;
  /// Density of sampling x_i, 1 <= i <= k, from x_{i+1} in direction from the light.
  double from_light(const WholePath& path, const VertexPool& pool, int i) const;
  /// The same densities if the direction towards x_i, or the film position, has density 1 and delta
  /// lobes have probability 1.
  double per_direction_from_eye(const WholePath& path, const VertexPool& pool, int i) const;
  double per_direction_from_light(const WholePath& path, const VertexPool& pool, int i) const;
  /// The sum over all j, first <= j < last, of the density of sampling the vertices between x_first
  /// and x_last with those up to x_j from the eye's side, the others from the light's, and x_j
  /// connected to x_{j+1}. With last = k + 1, the light's side starts on an emitter, and for j = k
  /// the path from the eye hits it.
  long double between(const WholePath& path, const VertexPool& pool, int first, int last) const;

  /// A film point, uniform over all positions that contribute to a pixel.
  V2f film_point(const V2f& u) const {
    return {u.x * film_size_.x - margin_, u.y * film_size_.y - margin_};
  }
  bool on_film(const V2f& at) const {
    return at.x >= -margin_ && at.y >= -margin_ && at.x < film_size_.x - margin_ &&
           at.y < film_size_.y - margin_;
  }
  const Scene& scene() const { return scene_; }
  const Camera& camera() const { return camera_; }

 private:
  const Scene& scene_;
  const Camera& camera_;
  float pixels_;  // number of pixels
  float margin_;  // reach of the filter beyond the film, pixels
  V2f film_size_;
};

}  // namespace lacuna
