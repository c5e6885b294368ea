#pragma once

#include <cstdint>
#include <numbers>

#include "renderer/core/bounds.h"
#include "renderer/emitters/direction_cone.h"

namespace lacuna {

/// What a light tree knows of an emitter, or of a group of emitters.
struct EmitterBounds {
  Bounds box;          ///< of all points that emit
  DirectionCone axes;  ///< of the normals of surfaces, and of the directions in which spots shine
  double reach = 0;    ///< largest angle to an axis at which light leaves; radians, in [0, pi]
  /// Surfaces emit along their normals and against them.
  bool both_sides = false;
  /// Largest radiant intensity in any direction, of groups the sum; > 0, in any one unit.
  double intensity = 0;

  /// Bounds both.
  static EmitterBounds join(const EmitterBounds& a, const EmitterBounds& b) {
    EmitterBounds r = a;
    for (int k = 0; k < 3; ++k) {
      r.box.low[k] = std::min(a.box.low[k], b.box.low[k]);
      r.box.high[k] = std::max(a.box.high[k], b.box.high[k]);
    }
    r.both_sides = a.both_sides || b.both_sides;
    DirectionCone other = b.axes;
    if (r.both_sides && other.axis.dot(a.axes.axis) < 0) {
      // Both directions of an axis mean the same, if all surfaces emit from both sides.
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
