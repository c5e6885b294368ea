#pragma once

#include <numbers>

#include "renderer/core/frame.h"
#include "renderer/path/guide.h"

namespace lacuna::test {

/// Directions around one of two far points, by the side of the surface that is asked for,
/// drawn with another probability on each side: as little alike as densities from both ends can be.
class SidedDirections final : public GuidingDistribution {
 public:
  /// `place`: of the far points; another for another distribution.
  explicit SidedDirections(float place = 1) : place_(place) {}

  bool needs_space() const override { return false; }
  std::size_t cells() const override { return 2; }
  AutoNumber probability() const override { return {1}; }
  GuidingCell cell(const Surface& s, const V3f& w) const override {
    return dot(w, s.ng) < 0 ? GuidingCell{0.7F, 1} : GuidingCell{0.3F, 0};
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint, Rng& rng) const override {
    const V2f u = rng.next2();
    const float z = std::cbrt(1 - u.x);
    const float r = std::sqrt(std::max(0.0F, 1 - z * z)), phi = 2 * pi * u.y;
    return Frame(axis(at.cell, at.x())).to_world({r * std::cos(phi), r * std::sin(phi), z});
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    const float c = std::max(0.0F, dot(axis(at.cell, at.x()), w));
    return Pdf<SolidAngle>(3 * c * c / (2 * pi));
  }

 private:
  V3f axis(const GuidingCell& cell, const V3f& x) const {
    return (place_ * (cell.index == 0 ? V3f(40, 90, -30) : V3f(-70, 20, 50)) - x).normalized();
  }

  float place_;
};

}  // namespace lacuna::test
