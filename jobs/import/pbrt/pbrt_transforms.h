#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

#include "jobs/import/pbrt/pbrt_tokens.h"
#include "renderer/core/vec.h"

namespace lacuna::pbrt {

// Matrices in Imath's convention, row vectors: p_world = p * m. So pbrt's CTM = CTM * T is here
// ctm = t * ctm, and the 16 numbers of `Transform` stand in the order of the file.

/// The current transformation matrices, at the start and at the end of the shutter.
class CurrentTransform {
 public:
  const M44d& start() const { return at_[0]; }
  bool is_animated() const { return at_[0] != at_[1]; }

  void set(const M44d& m);
  void concatenate(const M44d& t);
  /// `ActiveTransform All`, `StartTime` or `EndTime`: which ones set() and concatenate() change.
  void activate(const Token& which);
  bool operator==(const CurrentTransform&) const = default;

 private:
  std::array<M44d, 2> at_;
  std::array<bool, 2> active_{true, true};
};

/// Reads the numbers of the statement `name` and applies it; false if the name is no transform.
/// Throws SceneError for missing numbers and for a projective matrix.
bool read_transform(std::string_view name, Tokens& tokens, const Place& place,
                    CurrentTransform& ctm);

/// Whether an affine matrix has no inverse.
bool is_singular(const M44d& m);

}  // namespace lacuna::pbrt
