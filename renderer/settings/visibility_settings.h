#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "base/settings/field.h"
#include "renderer/settings/node_map_settings.h"

namespace lacuna {

/// visibility: exact.
struct ExactVisibilitySettings {
  static constexpr std::string_view name = "exact";
  static constexpr std::string_view doc = "a shadow ray tests every light that could contribute";
  bool operator==(const ExactVisibilitySettings&) const = default;
};
template <class V>
void describe(V&, ExactVisibilitySettings&) {}

/// visibility: none.
struct NoVisibilitySettings {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view doc =
      "no shadow rays: all lights shine through all surfaces (biased)";
  static constexpr bool biased = true;
  bool operator==(const NoVisibilitySettings&) const = default;
};
template <class V>
void describe(V&, NoVisibilitySettings&) {}

/// The variance that determines the probability of testing a light.
enum class VarianceOf { picture, point, cache_points };

template <>
struct EnumTable<VarianceOf> {
  static constexpr std::array<EnumValue<VarianceOf>, 3> values{{
      {VarianceOf::picture, "picture",
       "the variance of contributions over the whole picture, so that tests follow each pixel's "
       "share of the picture's error"},
      {VarianceOf::point, "point",
       "the variance of contributions at the nearest cache points, interpolated as if they had the "
       "shading point's albedo; if no light is visible from them, every light is tested"},
      {VarianceOf::cache_points, "cache_points",
       "the variance of contributions at the nearest cache points, interpolated as it is (Nabata "
       "et al., eq. 8)"},
  }};
};

/// How the lights to test are sampled, each with its own probability.
enum class TestDraws { systematic, bernoulli };

template <>
struct EnumTable<TestDraws> {
  static constexpr std::array<EnumValue<TestDraws>, 2> values{{
      {TestDraws::systematic, "systematic",
       "one random number for 64 neighbouring lights, so that the tests are distributed evenly "
       "over them"},
      {TestDraws::bernoulli, "bernoulli", "a random number for each light (eq. 3)"},
  }};
};

/// The lights that a cache point tests.
enum class CacheLights { lit, all };

template <>
struct EnumTable<CacheLights> {
  static constexpr std::array<EnumValue<CacheLights>, 2> values{{
      {CacheLights::lit, "lit",
       "those that contribute to the cache point; the visibility of the others, such as those "
       "behind its horizon, is unknown there"},
      {CacheLights::all, "all", "all lights (Nabata et al., 3.1)"},
  }};
};

/// Settings of strategies that test lights at random.
struct ChanceSettings {
  int cache_points = 2000;
  int neighbours = 3;
  double epsilon_probability = 0.1;
  // These differ from the published values, see their tables:
  double term_cost = 0.03;
  VarianceOf variance = VarianceOf::picture;
  TestDraws draws = TestDraws::systematic;
  bool operator==(const ChanceSettings&) const = default;
};

template <class V, class S>
void describe_cache(V& v, S& s, std::string_view what) {
  v("cache_points", s.cache_points, {.doc = what, .min = 1, .max = 1 << 20});
  v("neighbours", s.neighbours,
    {.doc = "nearest cache points, by distance and normal, that a shading point interpolates",
     .min = 1,
     .max = 8});
}

template <class V>
void describe_chance(V& v, ChanceSettings& s) {
  v("epsilon_probability", s.epsilon_probability,
    {.doc = "smallest probability of a test (Nabata et al., eq. 12)",
     .min = 0,
     .max = 1,
     .above_min = true});
  v("term_cost", s.term_cost,
    {.doc = "time to evaluate a light's contribution, as a fraction of the time of its shadow ray; "
            "0: only rays are counted (eq. 13)",
     .min = 0,
     .max = 1e6,
     .published = "0"});
  v("variance", s.variance,
    {.doc = "which variance is sigma^2 (eq. 8)", .published = "\"cache_points\""});
  v("draws", s.draws, {.doc = "how the lights to test are sampled", .published = "\"bernoulli\""});
}

template <class V, class S>
void describe_cache_lights(V& v, S& s, std::string_view published = {}) {
  v("cache_lights", s.cache_lights,
    {.doc = "the lights that a cache point tests", .published = published});
}

/// How the probability of testing a light depends on its contribution.
enum class RouletteRule { veach, derived };

template <>
struct EnumTable<RouletteRule> {
  static constexpr std::array<EnumValue<RouletteRule>, 2> values{{
      {RouletteRule::veach, "veach",
       "proportional to the contribution, reaching 1 at the threshold sigma / sqrt(n) (Veach 1997, "
       "10.4.1)"},
      {RouletteRule::derived, "derived",
       "minimises variance times time, as for probabilistic visibility"},
  }};
};

/// visibility: roulette.
struct RouletteVisibilitySettings : ChanceSettings {
  static constexpr std::string_view name = "roulette";
  static constexpr std::string_view doc =
      "efficiency-optimised Russian roulette: small contributions are tested with a low "
      "probability "
      "and weighted by its inverse (Veach 1997, 10.4.1)";

  RouletteRule rule = RouletteRule::veach;
  RouletteVisibilitySettings() { cache_points = 200, epsilon_probability = 0.001; }
  bool operator==(const RouletteVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, RouletteVisibilitySettings& s) {
  describe_cache(v, s, "shading points at which the variance of contributions is measured");
  describe_chance(v, s);
  v("rule", s.rule, {.doc = "how the probability of a test follows from a contribution"});
}

/// visibility: probabilistic.
struct ProbabilisticVisibilitySettings : ChanceSettings {
  static constexpr std::string_view name = "probabilistic";
  static constexpr std::string_view doc =
      "lights whose visibility is equal at nearby cache points are tested with a low probability; "
      "the control variate is the mean of these (Nabata et al.)";

  double epsilon_variance = 0.1;
  // These differ from the published values, see their tables:
  bool clamp_negative = false;
  CacheLights cache_lights = CacheLights::lit;
  bool operator==(const ProbabilisticVisibilitySettings&) const = default;
};

inline constexpr std::string_view cache_points_doc =
    "shading points at which the visibility of lights is tested: one for each cluster of the "
    "picture's shading points, split by position and normal";

template <class V>
void describe(V& v, ProbabilisticVisibilitySettings& s) {
  describe_cache(v, s, cache_points_doc);
  describe_chance(v, s);
  describe_cache_lights(v, s, "\"all\"");
  v("epsilon_variance", s.epsilon_variance,
    {.doc =
         "smallest variance assumed for a visibility, even where all cache points agree (eq. 11)",
     .min = 0,
     .max = 0.25,
     .above_min = true});
  v("clamp_negative", s.clamp_negative,
    {.doc = "set an iteration's negative pixels to black (section 4.2): biased",
     .published = "true"});
}

/// visibility: interpolated.
struct InterpolatedVisibilitySettings {
  static constexpr std::string_view name = "interpolated";
  static constexpr std::string_view doc =
      "no shadow rays: visibility is interpolated from nearby cache points (biased; Nabata et al., "
      "Fig. 6)";
  static constexpr bool biased = true;

  int cache_points = ChanceSettings{}.cache_points;
  int neighbours = ChanceSettings{}.neighbours;
  CacheLights cache_lights = CacheLights::all;
  bool operator==(const InterpolatedVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, InterpolatedVisibilitySettings& s) {
  describe_cache(v, s, cache_points_doc);
  describe_cache_lights(v, s);
}

/// How the light through a gate falls off towards its rim.
enum class GateFalloff { cosine, rim, none };

template <>
struct EnumTable<GateFalloff> {
  static constexpr std::array<EnumValue<GateFalloff>, 3> values{{
      {GateFalloff::cosine, "cosine",
       "the cosine of the angle between the ray from the light and the direction to the gate's "
       "centre"},
      {GateFalloff::rim, "rim",
       "1 - (r / R)^2, where the ray crosses the disk of radius R at distance r from its centre"},
      {GateFalloff::none, "none", "no falloff"},
  }};
};

/// What is tested against the cones of lights through gates.
enum class GateTests { points, clusters };

template <>
struct EnumTable<GateTests> {
  static constexpr std::array<EnumValue<GateTests>, 2> values{{
      {GateTests::points, "points", "every shading point"},
      {GateTests::clusters, "clusters",
       "the bounding spheres of geometry clusters, neighbouring points of similar depth and normal "
       "in one visibility cluster; then their points against the cones that meet the sphere "
       "(Noel 2015, 7.3.1 to 7.3.3): the same picture"},
  }};
};

/// visibility: gates.
struct GatesVisibilitySettings {
  static constexpr std::string_view name = "gates";
  static constexpr std::string_view doc =
      "no shadow rays: lights illuminate all points of their own visibility cluster, and others "
      "through the disks between clusters (biased; Noel 2015, ch. 7)";
  static constexpr bool biased = true;

  GateFalloff falloff = GateFalloff::cosine;
  bool through_gates = true;
  GateTests tests = GateTests::points;
  bool operator==(const GatesVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, GatesVisibilitySettings& s) {
  v("falloff", s.falloff, {.doc = "how the light through a gate falls off towards its rim"});
  v("through_gates", s.through_gates,
    {.doc = "lights illuminate other clusters through gates; otherwise only their own: faster, but "
            "distant light is missing (Noel 2015, 7.4.1)"});
  v("tests", s.tests,
    {.doc = "what is tested against the cones of lights through gates",
     .published = "\"clusters\""});
}

/// visibility: node_maps.
struct NodeMapsVisibilitySettings {
  static constexpr std::string_view name = "node_maps";
  static constexpr std::string_view doc =
      "no shadow rays: a light illuminates the points visible from its node of the filtered "
      "skeleton, by a cube map of depths around each node, stored on disk (biased; Noel 2015, ch. "
      "8)";
  static constexpr bool biased = true;

  int map_size = node_map_size;
  int filter = 5;
  bool operator==(const NodeMapsVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, NodeMapsVisibilitySettings& s) {
  describe_node_map_size(v, s.map_size);
  v("filter", s.filter,
    {.doc = "side, in texels, of the square over which depth comparisons are averaged "
            "(percentage-closer filtering)",
     .min = 1,
     .max = 7});
}

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

/// How the visibility between a virtual light and a shading point is estimated.
using VisibilitySettings =
    std::variant<ExactVisibilitySettings, NoVisibilitySettings, RouletteVisibilitySettings,
                 ProbabilisticVisibilitySettings, InterpolatedVisibilitySettings,
                 GatesVisibilitySettings, NodeMapsVisibilitySettings, ViewMapsVisibilitySettings>;

}  // namespace lacuna
