#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

inline constexpr int max_resolution = 2048;  ///< distances fit into 16 bits

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

/// The radius of a node of the skeleton, a corner of the lattice: that of its maximal ball.
enum class NodeRadius { corner, voxel, chessboard };

template <>
struct EnumTable<NodeRadius> {
  static constexpr std::array<EnumValue<NodeRadius>, 3> values{{
      {NodeRadius::corner, "corner",
       "from the node itself to the nearest closed voxel of the scene: 0 where a passage is one "
       "voxel wide"},
      {NodeRadius::voxel, "voxel",
       "the largest distance from a voxel at the node to the scene, between centres of voxels "
       "(thesis 6.2.2, 6.3): at least 1"},
      {NodeRadius::chessboard, "chessboard",
       "the same by the chessboard distance, as in the author's code; the filter then removes the "
       "nodes nearer than the radius, connected or not"},
  }};
};

/// What makes voxels of empty space a region.
enum class RegionLabelling { forest, openings };

template <>
struct EnumTable<RegionLabelling> {
  static constexpr std::array<EnumValue<RegionLabelling>, 2> values{{
      {RegionLabelling::forest, "forest",
       "their trees of the opening forest have a common root (thesis 10.3.3)"},
      {RegionLabelling::openings, "openings",
       "they are connected and have the same opening (thesis 10.3.2): many more regions, of which "
       "some lead nowhere"},
  }};
};

/// Shape analysis of the scene, for the integrators that use it.
struct AnalysisSettings {
  int resolution = 128;
  ThinningDistance distance = ThinningDistance::l1;
  NodeMapping mapping = NodeMapping::geodesic;
  double cluster_alpha = 0.2;
  RegionLabelling regions = RegionLabelling::forest;
  // The published value differs, see describe():
  NodeRadius node_radius = NodeRadius::corner;
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
  v("cluster_alpha", s.cluster_alpha,
    {.doc = "greatest relative difference between a node's radius and the largest radius of its "
            "visibility cluster (alpha of thesis 7.2.2)",
     .min = 0,
     .max = 1});
  v("regions", s.regions,
    {.doc = "what makes voxels of empty space a region; portals lie between regions"});
  v("node_radius", s.node_radius,
    {.doc = "the radius of a skeleton node, used to filter and simplify the skeleton and to make "
            "visibility clusters and gates",
     .published = "\"chessboard\""});
}

}  // namespace lacuna
