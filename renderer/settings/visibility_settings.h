#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "analysis/settings/field.h"

namespace lacuna {

/// visibility: exact.
struct ExactVisibilitySettings {
  static constexpr std::string_view name = "exact";
  static constexpr std::string_view doc = "every light that could add something is tested by a ray";
  bool operator==(const ExactVisibilitySettings&) const = default;
};
template <class V>
void describe(V&, ExactVisibilitySettings&) {}

/// visibility: none.
struct NoVisibilitySettings {
  static constexpr std::string_view name = "none";
  static constexpr std::string_view doc =
      "nothing is tested and all lights shine through everything (biased)";
  static constexpr bool biased = true;
  bool operator==(const NoVisibilitySettings&) const = default;
};
template <class V>
void describe(V&, NoVisibilitySettings&) {}

/// Of what the variance decides how often lights are tested.
enum class VarianceOf { picture, point };

template <>
struct EnumTable<VarianceOf> {
  static constexpr std::array<EnumValue<VarianceOf>, 2> values{{
      {VarianceOf::picture, "picture",
       "contributions anywhere in the picture: what counts is a pixel's share of its error"},
      {VarianceOf::point, "point",
       "contributions at the nearest cache points (Nabata et al., eq. 8); where they see no light, "
       "every light is tested"},
  }};
};

/// What all choices that test by chance have in common.
struct ChanceSettings {
  int cache_points = 2000;
  int neighbours = 3;
  double epsilon_probability = 0.1;
  // As published they are otherwise, see their tables:
  double term_cost = 0.03;
  VarianceOf variance = VarianceOf::picture;
  bool operator==(const ChanceSettings&) const = default;
};

template <class V, class S>
void describe_cache(V& v, S& s, std::string_view what) {
  v("cache_points", s.cache_points, {.doc = what, .min = 1, .max = 1 << 20});
  v("neighbours", s.neighbours,
    {.doc = "nearest cache points that a shading point takes its values from, by distance and "
            "normal",
     .min = 1,
     .max = 8});
}

template <class V>
void describe_chance(V& v, ChanceSettings& s, std::string_view published_variance = {}) {
  v("epsilon_probability", s.epsilon_probability,
    {.doc = "least probability of a test (Nabata et al., eq. 12)",
     .min = 0,
     .max = 1,
     .above_min = true});
  v("term_cost", s.term_cost,
    {.doc = "time of a light's contribution without its test, as a share of the time of the test; "
            "0: only rays count (eq. 13)",
     .min = 0,
     .max = 1e6,
     .published = "0"});
  v("variance", s.variance,
    {.doc = "of what sigma^2 is the variance (eq. 8)", .published = published_variance});
}

/// How a contribution's probability of a test follows from it.
enum class RouletteRule { veach, derived };

template <>
struct EnumTable<RouletteRule> {
  static constexpr std::array<EnumValue<RouletteRule>, 2> values{{
      {RouletteRule::veach, "veach",
       "in proportion, 1 from the threshold sigma / sqrt(n) on (Veach 1997, 10.4.1)"},
      {RouletteRule::derived, "derived",
       "where variance times time is least, as of probabilistic visibility"},
  }};
};

/// visibility: roulette.
struct RouletteVisibilitySettings : ChanceSettings {
  static constexpr std::string_view name = "roulette";
  static constexpr std::string_view doc =
      "small contributions are tested seldom and then count for more: efficiency-optimised Russian "
      "roulette (Veach 1997, 10.4.1)";

  RouletteRule rule = RouletteRule::veach;
  RouletteVisibilitySettings() { cache_points = 200, epsilon_probability = 0.001; }
  bool operator==(const RouletteVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, RouletteVisibilitySettings& s) {
  describe_cache(v, s, "shading points at which the contributions' variance is measured");
  describe_chance(v, s);
  v("rule", s.rule, {.doc = "how the probability of a test follows from a contribution"});
}

/// visibility: probabilistic.
struct ProbabilisticVisibilitySettings : ChanceSettings {
  static constexpr std::string_view name = "probabilistic";
  static constexpr std::string_view doc =
      "lights are tested seldom where what nearby cache points see makes the answer likely, and "
      "the estimate is corrected by those that are (Nabata et al.)";

  double epsilon_variance = 0.1;
  bool clamp_negative = false;  // as published it is otherwise
  bool operator==(const ProbabilisticVisibilitySettings&) const = default;
};

inline constexpr std::string_view cache_points_doc =
    "shading points at which every light's visibility is known: one for each part of the picture's "
    "points, split by position and normal";

template <class V>
void describe(V& v, ProbabilisticVisibilitySettings& s) {
  describe_cache(v, s, cache_points_doc);
  describe_chance(v, s, "\"point\"");
  v("epsilon_variance", s.epsilon_variance,
    {.doc = "least variance that a visibility is taken to have, also where all cache points agree "
            "(eq. 11)",
     .min = 0,
     .max = 0.25,
     .above_min = true});
  v("clamp_negative", s.clamp_negative,
    {.doc = "an iteration's pixels below zero become black (section 4.2): biased",
     .published = "true"});
}

/// visibility: interpolated.
struct InterpolatedVisibilitySettings {
  static constexpr std::string_view name = "interpolated";
  static constexpr std::string_view doc =
      "nothing is tested: visibility is what nearby cache points see (biased; Nabata et al., Fig. "
      "6)";
  static constexpr bool biased = true;

  int cache_points = ChanceSettings{}.cache_points;
  int neighbours = ChanceSettings{}.neighbours;
  bool operator==(const InterpolatedVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, InterpolatedVisibilitySettings& s) {
  describe_cache(v, s, cache_points_doc);
}

/// How the light through a gate fades towards its rim.
enum class GateFalloff { cosine, rim, none };

template <>
struct EnumTable<GateFalloff> {
  static constexpr std::array<EnumValue<GateFalloff>, 3> values{{
      {GateFalloff::cosine, "cosine",
       "the cosine between the light's ray and the way from it to the gate's centre"},
      {GateFalloff::rim, "rim",
       "1 - (r / R)^2 where the ray crosses the disk at r of its radius R"},
      {GateFalloff::none, "none", "not at all"},
  }};
};

/// visibility: gates.
struct GatesVisibilitySettings {
  static constexpr std::string_view name = "gates";
  static constexpr std::string_view doc =
      "nothing is tested: lights shine on all points of their own visibility cluster, and on "
      "others "
      "through the disks between clusters (biased; Noel 2015, ch. 7)";
  static constexpr bool biased = true;

  GateFalloff falloff = GateFalloff::cosine;
  bool operator==(const GatesVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, GatesVisibilitySettings& s) {
  v("falloff", s.falloff, {.doc = "how the light through a gate fades towards its rim"});
}

/// visibility: node_maps.
struct NodeMapsVisibilitySettings {
  static constexpr std::string_view name = "node_maps";
  static constexpr std::string_view doc =
      "nothing is tested: a light shines on what the nearest node of the filtered skeleton sees, "
      "by "
      "a cube map of distances around each node, kept on disk (biased; Noel 2015, ch. 8)";
  static constexpr bool biased = true;

  int map_size = 128;
  int filter = 5;
  bool operator==(const NodeMapsVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, NodeMapsVisibilitySettings& s) {
  v("map_size", s.map_size,
    {.doc = "texels along the sides of a map's six faces; 2 bytes each", .min = 8, .max = 1024});
  v("filter", s.filter,
    {.doc =
         "texels along the sides of the square that answers are averaged over (percentage-closer "
         "filtering)",
     .min = 1,
     .max = 7});
}

/// How the maps of all lights are made.
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
       "every leaf of the scene's octree that a light may see is drawn into its map"},
  }};
};

/// In which order pairs of a node of the scene and a node of the lights are looked at.
enum class ViewTraversal { depth_first, breadth_first };

template <>
struct EnumTable<ViewTraversal> {
  static constexpr std::array<EnumValue<ViewTraversal>, 2> values{{
      {ViewTraversal::depth_first, "depth_first", "branch by branch, which holds nearly none"},
      {ViewTraversal::breadth_first, "breadth_first",
       "by a queue of one generation after another, with a map for every node of the lights' "
       "octree (the same picture, for the memory it takes)"},
  }};
};

/// visibility: view_maps.
struct ViewMapsVisibilitySettings {
  static constexpr std::string_view name = "view_maps";
  static constexpr std::string_view doc =
      "nothing is tested: every light has a small map of distances to the leaves of the scene's "
      "octree (biased; Kol et al. 2018)";
  static constexpr bool biased = true;

  ViewMapMethod method = ViewMapMethod::megaviews;
  int map_size = 16;
  int levels = 9;
  double memory = 4;
  bool cull = true;
  // As published they are otherwise, see their tables:
  double node_texels = 1.75;
  double cover = 0.82;
  ViewTraversal traversal = ViewTraversal::depth_first;
  bool operator==(const ViewMapsVisibilitySettings&) const = default;
};
template <class V>
void describe(V& v, ViewMapsVisibilitySettings& s) {
  v("method", s.method, {.doc = "how the maps are made"});
  v("map_size", s.map_size,
    {.doc = "texels along the sides of each half of a light's dual paraboloid map; 2 bytes each",
     .min = 8,
     .max = 256});
  v("levels", s.levels,
    {.doc = "of the octrees: the scene's longest side has 2^levels cubes", .min = 1, .max = 11});
  v("node_texels", s.node_texels,
    {.doc =
         "texels that the sphere around a node may show across where it is rendered as one: at 1 "
         "no hole can be; at 1.75 a cube's side shows about one, which costs less than half, and "
         "larger maps for the same time err less. Not for per_view",
     .min = 0.25,
     .max = 4,
     .published = "1"});
  v("cover", s.cover,
    {.doc =
         "a node fills the texels whose middles lie within this share of the radius of its sphere, "
         "so that what is thinner than a texel hides little; below 0.82 a wall of cubes has holes, "
         "and yet some scenes err least near 0.65; 0: it fills the texel that its middle falls "
         "into, whatever it covers of it, and shadows are larger. Not for per_view",
     .min = 0,
     .max = 1,
     .published = "0"});
  v("memory", s.memory,
    {.doc =
         "that the maps may take; where those of all lights would take more, the picture is made "
         "in several passes, each with a part of the lights",
     .min = 0.0001,
     .max = 4096,
     .unit = "GiB"});
  v("cull", s.cull,
    {.doc = "what lies behind all lights of a node is left out of their maps: the same picture, "
            "sooner. Not for per_view"});
  v("traversal", s.traversal,
    {.doc = "in which order pairs of nodes of both octrees are looked at. Not for per_view",
     .published = "\"breadth_first\""});
}

/// Whether a virtual light and a shading point see one another.
using VisibilitySettings =
    std::variant<ExactVisibilitySettings, NoVisibilitySettings, RouletteVisibilitySettings,
                 ProbabilisticVisibilitySettings, InterpolatedVisibilitySettings,
                 GatesVisibilitySettings, NodeMapsVisibilitySettings, ViewMapsVisibilitySettings>;

}  // namespace lacuna
