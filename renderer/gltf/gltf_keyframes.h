#pragma once

#include <vector>

#include "renderer/gltf/gltf_accessors.h"

namespace lacuna::gltf {

enum class AnimatedKind { vector, rotation, weights };

/// A sampler of an animation: keys at increasing times, and the interpolation between them.
class Keyframes {
 public:
  /// Throws SceneError if the accessors of `sampler` do not fit the `kind`.
  Keyframes(const GltfObject& sampler, const file::Model& model, AnimatedKind kind);

  /// The value at a time, which is clamped to the times of the first and the last key (glTF 2.0,
  /// appendix C).
  std::vector<double> at(double seconds) const;

 private:
  enum class Interpolation { linear, step, cubic };
  enum Part { in_tangent, value, out_tangent };  // of a key of a cubic spline

  std::vector<double> part(std::size_t key, Part which) const;
  std::vector<double> slerp(std::size_t key, double u) const;
  std::vector<double> hermite(std::size_t key, double u, double seconds_between) const;
  /// A rotation is normalised; other values do not change.
  std::vector<double> finished(std::vector<double> v) const;

  const GltfObject& sampler_;
  AnimatedKind kind_;
  Interpolation interpolation_;
  std::vector<float> times_;
  AccessorView values_;
  std::size_t width_ = 1;  ///< elements of values_ for each value
};

}  // namespace lacuna::gltf
