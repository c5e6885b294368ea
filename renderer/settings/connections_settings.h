#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "analysis/settings/field.h"

namespace lacuna {

/// How several resampling distributions over the same light paths become one.
enum class Combination { mixture, max };

template <>
struct EnumTable<Combination> {
  static constexpr std::array<EnumValue<Combination>, 2> values{{
      {Combination::mixture, "mixture", "their mean (balance heuristic)"},
      {Combination::max, "max",
       "each light path only by the distribution that gives it most, all of them renormalised and "
       "drawn from equally often (max heuristic, pre-multiplied; Noel 2015, 11.3)"},
  }};
};

/// Which light vertices a distribution that does not look at visibility takes.
enum class LightSides { facing, both };

template <>
struct EnumTable<LightSides> {
  static constexpr std::array<EnumValue<LightSides>, 2> values{{
      {LightSides::facing, "facing", "those that scatter towards the node or record"},
      {LightSides::both, "both", "all, also those that turn their back to it"},
  }};
};

/// What all choices of connections but `paired` have in common.
struct ResamplingSettings {
  int light_paths = 1024;
  // As published they are otherwise, see their tables:
  int count_as = 8;
  double splat_paths = 0.25;
  double roulette = 0.3;
  bool operator==(const ResamplingSettings&) const = default;
};

template <class V>
void describe_resampling(V& v, ResamplingSettings& s) {
  v("light_paths", s.light_paths,
    {.doc = "light paths an iteration that eye paths are joined to, shared by all pixels",
     .min = 1,
     .max = 1 << 16});
  v("splat_paths", s.splat_paths,
    {.doc = "light paths an iteration that are joined to the eye, as a share of the pixels; those "
            "that eye paths are joined to always are",
     .min = 0,
     .max = 16,
     .published = "1"});
  v("count_as", s.count_as,
    {.doc =
         "as how many samples a connection with a resampled path of two vertices or more counts "
         "in the weights of multiple importance sampling; one with a point on an emitter counts as "
         "one. 0: both as many as there are light paths (Noel 2015, 11.5)",
     .min = 0,
     .max = 1 << 16,
     .published = "0"});
  v("roulette", s.roulette,
    {.doc =
         "a connection is made with a probability in proportion to what those of its length gave "
         "in its part of the empty space before; certainly, if that is this share of what all "
         "connections of a path give in its part of the picture. 0: all are made",
     .min = 0,
     .max = 1,
     .published = "0"});
}

/// connections: paired.
struct PairedSettings {
  static constexpr std::string_view name = "paired";
  static constexpr std::string_view doc =
      "every pixel's path to a light path of its own and, at each vertex, to a fresh point on an "
      "emitter";
  bool operator==(const PairedSettings&) const = default;
};
template <class V>
void describe(V&, PairedSettings&) {}

/// connections: uniform.
struct UniformSettings : ResamplingSettings {
  static constexpr std::string_view name = "uniform";
  static constexpr std::string_view doc =
      "one of the shared light paths at random, for each length";
  bool operator==(const UniformSettings&) const = default;
};
template <class V>
void describe(V& v, UniformSettings& s) {
  describe_resampling(v, s);
}

/// connections: skeleton.
struct SkeletonConnectionsSettings : ResamplingSettings {
  static constexpr std::string_view name = "skeleton";
  static constexpr std::string_view doc =
      "light paths resampled by distributions at the skeleton's nodes (Noel 2015, ch. 11)";

  double acceptance = 1;
  bool visible = true;
  bool unshadowed = true;
  Combination combination = Combination::mixture;  // as published it is otherwise
  LightSides sides = LightSides::facing;
  bool operator==(const SkeletonConnectionsSettings&) const = default;
};
template <class V, class S>
void describe_acceptance(V& v, S& s) {
  v("acceptance", s.acceptance,
    {.doc = "a node has distributions if more eye vertices belonged to it than this times the mean "
            "over nodes; elsewhere light paths are drawn uniformly",
     .min = 0,
     .max = 1e6});
}
template <class V>
void describe(V& v, SkeletonConnectionsSettings& s) {
  describe_resampling(v, s);
  describe_acceptance(v, s);
  v("visible", s.visible,
    {.doc = "distribution V: contribution over squared distance, of what the node sees (eq. 188)"});
  v("unshadowed", s.unshadowed, {.doc = "distribution U: the same of all (eq. 189)"});
  v("combination", s.combination,
    {.doc = "of V, U and the uniform distribution C", .published = "\"max\""});
  v("sides", s.sides, {.doc = "light vertices that V and U take"});
}

/// connections: importance_cache.
struct ImportanceCacheSettings : ResamplingSettings {
  static constexpr std::string_view name = "importance_cache";
  static constexpr std::string_view doc =
      "light paths resampled by distributions at records on surfaces (Georgiev et al. 2012)";

  double record_density = 0.001;
  int neighbours = 3;
  bool full = true;
  bool unshadowed = false;
  bool bounded = false;
  Combination combination = Combination::mixture;  // as published it is otherwise
  bool operator==(const ImportanceCacheSettings&) const = default;
};
template <class V, class S>
void describe_records(V& v, S& s) {
  v("record_density", s.record_density,
    {.doc = "paths from the eye whose vertices become records, as a share of the pixels",
     .min = 0,
     .max = 0.1,
     .above_min = true});
  v("neighbours", s.neighbours,
    {.doc = "nearest records of an eye vertex, one of which is drawn", .min = 1, .max = 64});
}
template <class V>
void describe(V& v, ImportanceCacheSettings& s) {
  describe_resampling(v, s);
  describe_records(v, s);
  v("full", s.full, {.doc = "distribution F: the record's whole contribution, with visibility"});
  v("unshadowed", s.unshadowed, {.doc = "distribution U: the same without visibility"});
  v("bounded", s.bounded,
    {.doc = "distribution B: without visibility, and without what only holds at the record: its "
            "BSDF and the distance"});
  v("combination", s.combination,
    {.doc = "of F, U, B and the uniform distribution C", .published = "\"max\""});
}

/// connections: hybrid. Records are dense where the eye looks and too few elsewhere; nodes are
/// everywhere.
struct HybridSettings : ResamplingSettings {
  static constexpr std::string_view name = "hybrid";
  static constexpr std::string_view doc =
      "as importance_cache at the first vertices of an eye's path, as skeleton beyond (Noel 2015, "
      "11.6)";

  int cached_depth = 1;
  double record_density = ImportanceCacheSettings{}.record_density;
  int neighbours = ImportanceCacheSettings{}.neighbours;
  double acceptance = SkeletonConnectionsSettings{}.acceptance;
  Combination combination = Combination::mixture;  // as published it is otherwise
  bool operator==(const HybridSettings&) const = default;

  ImportanceCacheSettings cache() const {
    ImportanceCacheSettings s{*this};
    s.record_density = record_density;
    s.neighbours = neighbours;
    s.combination = combination;
    return s;
  }
  SkeletonConnectionsSettings skeleton() const {
    SkeletonConnectionsSettings s{*this};
    s.acceptance = acceptance;
    s.combination = combination;
    return s;
  }
};
template <class V>
void describe(V& v, HybridSettings& s) {
  describe_resampling(v, s);
  v("cached_depth", s.cached_depth,
    {.doc = "vertices up to this many edges from the eye use records",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
  describe_records(v, s);
  describe_acceptance(v, s);
  v("combination", s.combination,
    {.doc = "of F and C at records, and of V, U and C at nodes", .published = "\"max\""});
}

/// Which light vertices meet an eye vertex.
using ConnectionsSettings =
    std::variant<PairedSettings, UniformSettings, SkeletonConnectionsSettings,
                 ImportanceCacheSettings, HybridSettings>;

}  // namespace lacuna
