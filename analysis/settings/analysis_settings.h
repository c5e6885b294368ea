#pragma once

#include <array>

#include "analysis/settings/field.h"

namespace lacuna {

/// To which node a voxel of empty space belongs.
enum class NodeMapping { geodesic, visible };

template <>
struct EnumTable<NodeMapping> {
  static constexpr std::array<EnumValue<NodeMapping>, 2> values{{
      {NodeMapping::geodesic, "geodesic", "the nearest node, through empty space (thesis Alg. 5)"},
      {NodeMapping::visible, "visible",
       "the nearest node that the voxel sees, where it sees one near by"},
  }};
};

/// Shape analysis of the scene, for the integrators that use it.
struct AnalysisSettings {
  int resolution = 128;
  NodeMapping mapping = NodeMapping::geodesic;
  bool operator==(const AnalysisSettings&) const = default;
};

template <class V>
void describe(V& v, AnalysisSettings& s) {
  v("resolution", s.resolution,
    {.doc = "voxels along the longest side of the scene", .min = 1, .max = 2048, .unit = "voxels"});
  v("mapping", s.mapping, {.doc = "the node that a voxel of empty space belongs to"});
}

}  // namespace lacuna
