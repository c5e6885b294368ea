#pragma once

#include <array>
#include <string_view>

#include "base/settings/field.h"

namespace lacuna {

/// How the maps of all lights are rendered.
enum class ViewMapMethod { megaviews, many_lods, per_view, per_view_splats };

template <>
struct EnumTable<ViewMapMethod> {
  static constexpr std::array<EnumValue<ViewMapMethod>, 4> values{{
      {ViewMapMethod::megaviews, "megaviews",
       "the octrees of the scene and of the lights are traversed together (Kol et al. 2018)"},
      {ViewMapMethod::many_lods, "many_lods",
       "the scene's octree is traversed for each light (Hollaender et al. 2011)"},
      {ViewMapMethod::per_view, "per_view", "a ray for each texel of each light's map"},
      {ViewMapMethod::per_view_splats, "per_view_splats",
       "every leaf of the scene's octree that may be visible from a light is splatted into its "
       "map"},
  }};
};

/// Which lights have their own map.
enum class ViewSharing { cells, none };

template <>
struct EnumTable<ViewSharing> {
  static constexpr std::array<EnumValue<ViewSharing>, 2> values{{
      {ViewSharing::cells, "cells", "the lights in a leaf of their octree share a map"},
      {ViewSharing::none, "none", "every light has its own map. Not for megaviews"},
  }};
};

/// The bounds of both nodes that decide whether a pair is culled.
enum class ViewBounds { boxes, spheres };

template <>
struct EnumTable<ViewBounds> {
  static constexpr std::array<EnumValue<ViewBounds>, 2> values{{
      {ViewBounds::boxes, "boxes",
       "the boxes of the leaves and of the lights below them: then the coarse nodes of the wall "
       "that carries a light lie behind it"},
      {ViewBounds::spheres, "spheres", "the spheres around their cubes and lights"},
  }};
};

/// How the octree of the lights is subdivided.
enum class ViewSplit { facing, position };

template <>
struct EnumTable<ViewSplit> {
  static constexpr std::array<EnumValue<ViewSplit>, 2> values{{
      {ViewSplit::facing, "facing",
       "by their positions into 64^3 cubes, then by the largest coordinate of their normals, then "
       "by their positions again: the lights of a node see more similar parts of the scene"},
      {ViewSplit::position, "position", "by their positions"},
  }};
};

/// How rays are traced.
enum class ViewRays { packets, single };

template <>
struct EnumTable<ViewRays> {
  static constexpr std::array<EnumValue<ViewRays>, 2> values{{
      {ViewRays::packets, "packets", "eight neighbours at once, as coherent packets"},
      {ViewRays::single, "single", "one by one"},
  }};
};

/// The order in which pairs of a scene node and a light node are processed.
enum class ViewTraversal { depth_first, breadth_first };

template <>
struct EnumTable<ViewTraversal> {
  static constexpr std::array<EnumValue<ViewTraversal>, 2> values{{
      {ViewTraversal::depth_first, "depth_first",
       "branch by branch, with almost no pairs in memory"},
      {ViewTraversal::breadth_first, "breadth_first",
       "by a queue, one generation after another, with a map for every node of the lights' octree "
       "(the same picture, but more memory)"},
  }};
};

/// How a texel of a light's map is looked up.
enum class ViewQueries { fused, descend };

template <>
struct EnumTable<ViewQueries> {
  static constexpr std::array<EnumValue<ViewQueries>, 2> values{{
      {ViewQueries::fused, "fused",
       "one texel: the maps of all nodes are copied down to the leaves first (Kol et al. 2018, "
       "3.2.5)"},
      {ViewQueries::descend, "descend",
       "a texel of every map between the root and the leaf: no copies, the same picture, but more "
       "memory and slower queries. The traversal is breadth-first; not for per_view"},
  }};
};

/// How a leaf of the scene's octree that is larger than a texel is drawn.
enum class ViewFilling { texels, mips };

template <>
struct EnumTable<ViewFilling> {
  static constexpr std::array<EnumValue<ViewFilling>, 2> values{{
      {ViewFilling::texels, "texels", "into every texel whose centre it covers"},
      {ViewFilling::mips, "mips",
       "into one texel of a coarser level of the map, which is pushed down to the finest level "
       "afterwards (Kol et al. 2018, 3.2.4): larger shadows"},
  }};
};

/// visibility: view_maps.
struct ViewMapsVisibilitySettings {
  static constexpr std::string_view name = "view_maps";
  static constexpr std::string_view doc =
      "no shadow rays: every light has a small map of distances to the leaves of the scene's "
      "octree "
      "(biased; Kol et al. 2018)";
  static constexpr bool biased = true;

  ViewMapMethod method = ViewMapMethod::megaviews;
  int map_size = 16;
  double levels = 9;
  double memory = 4;
  bool cull = true;
  ViewRays rays = ViewRays::single;
  ViewQueries queries = ViewQueries::fused;
  // These differ from the published values, see their tables:
  double node_texels = 1.75;
  double cover = 0.82;
  ViewSharing share = ViewSharing::cells;
  ViewBounds bounds = ViewBounds::boxes;
  ViewSplit split = ViewSplit::facing;
  ViewTraversal traversal = ViewTraversal::depth_first;
  ViewFilling filling = ViewFilling::texels;
  bool operator==(const ViewMapsVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, ViewMapsVisibilitySettings& s) {
  v("method", s.method, {.doc = "how the maps are rendered"});
  v("map_size", s.map_size,
    {.doc = "texels along a side of each half of a light's dual paraboloid map; 2 bytes each",
     .min = 8,
     .max = 1024});
  v("levels", s.levels,
    {.doc = "levels of the octrees: the scene's longest side has 2^levels cubes, which need not "
            "be a whole number",
     .min = 1,
     .max = 11});
  v("node_texels", s.node_texels,
    {.doc =
         "diameter, in texels, of the largest node sphere that is rendered as one splat. 1 leaves "
         "no holes; at 1.75 the side of a cube covers about one texel, at less "
         "than half the cost, and larger maps at equal time have less error. Not for per_view",
     .min = 0.25,
     .max = 4,
     .published = "1"});
  v("cover", s.cover,
    {.doc = "a node fills the texels whose centres lie within this fraction of its sphere's "
            "radius, so that objects thinner than a texel occlude little. Below 0.82 a wall of "
            "cubes has holes, yet in some scenes the error is smallest near 0.65. 0: it fills the "
            "texel that contains its centre, even if it covers little of it, and shadows are "
            "larger. Not for per_view",
     .min = 0,
     .max = 1,
     .published = "0"});
  v("memory", s.memory,
    {.doc = "memory limit of the maps; if the maps of all lights need more, an iteration takes "
            "several passes, each for part of the lights",
     .min = 0.0001,
     .max = 4096,
     .unit = "GiB"});
  v("cull", s.cull,
    {.doc = "skip scene nodes that lie behind all lights of a node: the same picture, faster. Not "
            "for per_view"});
  v("share", s.share,
    {.doc = "which lights share a map; in the paper's many_lods, and with its rays, none do",
     .published = "\"none\""});
  v("bounds", s.bounds,
    {.doc = "bounds of nodes by which pairs are culled. Not for per_view",
     .published = "\"spheres\""});
  v("split", s.split,
    {.doc = "how lights are divided into nodes and cells. Not for lights that share no maps",
     .published = "\"position\""});
  v("rays", s.rays, {.doc = "how per_view traces its rays"});
  v("queries", s.queries, {.doc = "how a texel of a light's map is looked up"});
  v("filling", s.filling,
    {.doc = "how leaves of the scene's octree larger than a texel are drawn. Not for per_view"});
  v("traversal", s.traversal,
    {.doc = "order in which pairs of nodes of both octrees are processed. Not for per_view",
     .published = "\"breadth_first\""});
}

}  // namespace lacuna
