#pragma once

#include <vector>

#include "renderer/gltf/gltf_accessors.h"

namespace lacuna::gltf {

enum class AnimatedKind { vector, rotation, weights };

/// A sampler of an animation: values at rising times, and how those between are made.
class Keyframes {
 public:
  /// Throws SceneError where the accessors of `sampler` are not those of the `kind`.
  Keyframes(const GltfObject& sampler, const file::Model& model, AnimatedKind kind);

  /// The value at a time; before the first key and after the last one, theirs (glTF 2.0, appendix
  /// C).
  std::vector<double> at(double seconds) const;

 private:
  enum class Interpolation { linear, step, cubic };
  enum Part { in_tangent, value, out_tangent };  // of a key of a cubic spline

  std::vector<double> part(std::size_t key, Part which) const;
  std::vector<double> slerp(std::size_t key, double u) const;
  std::vector<double> hermite(std::size_t key, double u, double seconds_between) const;
  /// A rotation of length 1; other values as they are.
  std::vector<double> finished(std::vector<double> v) const;

  const GltfObject& sampler_;
  AnimatedKind kind_;
  Interpolation interpolation_;
  std::vector<float> times_;
  AccessorView values_;
  std::size_t width_ = 1;  ///< elements of values_ for each value
};

}  // namespace lacuna::gltf
