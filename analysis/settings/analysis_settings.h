#pragma once

#include <array>

#include "analysis/settings/field.h"

namespace lacuna {

inline constexpr int max_resolution = 2048;  ///< distances keep to 16 bits

/// The distance of a voxel to the scene by which thinning decides which curves to keep.
enum class ThinningDistance { l1, chebyshev };

template <>
struct EnumTable<ThinningDistance> {
  static constexpr std::array<EnumValue<ThinningDistance>, 2> values{{
      {ThinningDistance::l1, "l1", "steps across voxel faces (thesis 6.2.3)"},
      {ThinningDistance::chebyshev, "chebyshev",
       "steps across faces, edges and corners: fewer short spurs where the scene is rough"},
  }};
};

/// The skeleton node that a voxel of empty space belongs to.
enum class NodeMapping { geodesic, visible };

template <>
struct EnumTable<NodeMapping> {
  static constexpr std::array<EnumValue<NodeMapping>, 2> values{{
      {NodeMapping::geodesic, "geodesic", "the geodesically nearest node (thesis Alg. 5)"},
      {NodeMapping::visible, "visible",
       "the nearest node that the voxel sees, if there is one nearby"},
  }};
};

/// Shape analysis of the scene, for the integrators that use it.
struct AnalysisSettings {
  int resolution = 128;
  ThinningDistance distance = ThinningDistance::l1;
  NodeMapping mapping = NodeMapping::geodesic;
  bool operator==(const AnalysisSettings&) const = default;
};

template <class V>
void describe(V& v, AnalysisSettings& s) {
  v("resolution", s.resolution,
    {.doc = "voxels along the longest side of the scene",
     .min = 1,
     .max = max_resolution,
     .unit = "voxels"});
  v("distance", s.distance, {.doc = "the distance that decides which curves thinning keeps"});
  v("mapping", s.mapping, {.doc = "the skeleton node that a voxel of empty space belongs to"});
}

}  // namespace lacuna
