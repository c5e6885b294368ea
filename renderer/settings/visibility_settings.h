#pragma once

#include <array>
#include <string_view>
#include <variant>
#include <vector>

#include "base/settings/field.h"
#include "renderer/settings/node_map_settings.h"
#include "renderer/settings/view_maps_settings.h"

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

inline constexpr std::string_view cache_points_doc =
    "shading points at which the visibility of lights is tested: one for each cluster of the "
    "picture's shading points, split by position and normal";

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

/// guess: cache_points.
struct CachePointsGuessSettings {
  static constexpr std::string_view name = "cache_points";
  static constexpr std::string_view doc =
      "the mean visibility of the nearest cache points (Nabata et al., 3.1)";
  bool operator==(const CachePointsGuessSettings&) const = default;
};
template <class V>
void describe(V&, CachePointsGuessSettings&) {}

/// guess: cells.
struct CellsGuessSettings {
  static constexpr std::string_view name = "cells";
  static constexpr std::string_view doc =
      "no answer for a single light: the learned rate is the mean visibility between two cells";
  bool operator==(const CellsGuessSettings&) const = default;
};
template <class V>
void describe(V&, CellsGuessSettings&) {}

/// One source of guesses.
using SourceSettings =
    std::variant<CachePointsGuessSettings, ViewMapsVisibilitySettings, NodeMapsVisibilitySettings,
                 GatesVisibilitySettings, CellsGuessSettings>;

/// guess: mixture.
struct MixtureGuessSettings {
  static constexpr std::string_view name = "mixture";
  static constexpr std::string_view doc =
      "the answers of several sources together: rates are learned for each combination of them";

  std::vector<SourceSettings> of;
  bool operator==(const MixtureGuessSettings&) const = default;
};
template <class V>
void describe(V& v, MixtureGuessSettings& s) {
  v("of", s.of, {.doc = "the sources", .min = 2, .max = 3, .required = true});
}

/// A source, or several.
using GuessSettings =
    std::variant<CachePointsGuessSettings, ViewMapsVisibilitySettings, NodeMapsVisibilitySettings,
                 GatesVisibilitySettings, CellsGuessSettings, MixtureGuessSettings>;

/// How often a guess is taken to be wrong.
enum class Reliability { by_guess, assumed, picture, clusters };

template <>
struct EnumTable<Reliability> {
  static constexpr std::array<EnumValue<Reliability>, 4> values{{
      {Reliability::by_guess, "by_guess", "assumed for cache_points alone, else clusters"},
      {Reliability::assumed, "assumed",
       "the variance of a visibility is q (1 - q), at least "
       "epsilon_variance (eq. 11)"},
      {Reliability::picture, "picture", "rates learned from the tests of earlier iterations"},
      {Reliability::clusters, "clusters",
       "the same for each pair of the visibility clusters of point and light"},
  }};
};

/// visibility: probabilistic.
struct ProbabilisticVisibilitySettings : ChanceSettings {
  static constexpr std::string_view name = "probabilistic";
  static constexpr std::string_view doc =
      "lights whose guessed visibility is reliable, by default equal at nearby cache points, are "
      "tested with a low probability; the guess is the control variate (Nabata et al.)";

  double epsilon_variance = 0.1;
  // These differ from the published values, see their tables:
  bool clamp_negative = false;
  CacheLights cache_lights = CacheLights::lit;
  GuessSettings guess = CachePointsGuessSettings{};
  Reliability reliability = Reliability::by_guess;
  int variance_points = 200;

  /// Whether the error rates of the guess are learned, and whether by cell.
  bool learned_rates() const {
    return reliability == Reliability::by_guess
               ? !std::holds_alternative<CachePointsGuessSettings>(guess)
               : reliability != Reliability::assumed;
  }
  bool reliability_cells() const { return learned_rates() && reliability != Reliability::picture; }
  bool operator==(const ProbabilisticVisibilitySettings&) const = default;
};

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
  v("guess", s.guess,
    {.doc = "where the guessed visibility of a light comes from; any guess leaves the mean right"});
  v("reliability", s.reliability, {.doc = "how often the guess is taken to be wrong"});
  v("variance_points", s.variance_points,
    {.doc = "shading points at which the variance of contributions is measured, if the guess is "
            "not by cache points",
     .min = 1,
     .max = 1 << 20});
}

/// How the visibility between a virtual light and a shading point is estimated.
using VisibilitySettings =
    std::variant<ExactVisibilitySettings, NoVisibilitySettings, RouletteVisibilitySettings,
                 ProbabilisticVisibilitySettings, InterpolatedVisibilitySettings,
                 GatesVisibilitySettings, NodeMapsVisibilitySettings, ViewMapsVisibilitySettings>;

}  // namespace lacuna
