#pragma once

#include <cstdint>
#include <numbers>

#include "renderer/core/bounds.h"
#include "renderer/emitters/direction_cone.h"

namespace lacuna {

/// The data of a light tree for an emitter, or for a group of emitters.
struct EmitterBounds {
  Bounds box;          ///< of all emitting points
  DirectionCone axes;  ///< of the normals of surfaces, and of the axes of spots
  double reach = 0;    ///< largest angle to an axis at which light is emitted; radians, in [0, pi]
  /// Whether surfaces emit from both sides.
  bool both_sides = false;
  /// Largest radiant intensity in any direction, for groups the sum; > 0, in any common unit.
  double intensity = 0;

  /// Bounds of both.
  static EmitterBounds join(const EmitterBounds& a, const EmitterBounds& b) {
    EmitterBounds r = a;
    for (int k = 0; k < 3; ++k) {
      r.box.low[k] = std::min(a.box.low[k], b.box.low[k]);
      r.box.high[k] = std::max(a.box.high[k], b.box.high[k]);
    }
    r.both_sides = a.both_sides || b.both_sides;
    DirectionCone other = b.axes;
    if (r.both_sides && other.axis.dot(a.axes.axis) < 0) {
      // If all surfaces emit from both sides, an axis and its opposite are equivalent.
      if (a.both_sides && b.both_sides) other.axis = -other.axis;
    }
    r.axes = DirectionCone::join(a.axes, other);
    r.reach = std::max(a.reach, b.reach);
    r.intensity = a.intensity + b.intensity;
    return r;
  }
};

/// The emitters of a light tree, by their number in the EmitterSet.
struct TreeEmitter {
  EmitterBounds bounds;
  std::uint32_t entry = 0;
};

}  // namespace lacuna
