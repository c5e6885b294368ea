#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "base/settings/field.h"
#include "renderer/settings/departures.h"
#include "renderer/settings/emitter_settings.h"
#include "renderer/settings/node_map_settings.h"

namespace lacuna {

/// How several resampling distributions over the same light vertices are combined.
enum class Combination { mixture, max };

template <>
struct EnumTable<Combination> {
  static constexpr std::array<EnumValue<Combination>, 2> values{{
      {Combination::mixture, "mixture", "their mean (balance heuristic)"},
      {Combination::max, "max",
       "each light vertex is sampled only from the distribution that gives it the highest "
       "probability; the distributions are renormalised and equally probable (max heuristic, "
       "pre-multiplied; Noel 2015, 11.3)"},
  }};
};

/// Which light vertices a distribution without visibility includes.
enum class LightSides { facing, both };

template <>
struct EnumTable<LightSides> {
  static constexpr std::array<EnumValue<LightSides>, 2> values{{
      {LightSides::facing, "facing", "those that scatter towards the node or record"},
      {LightSides::both, "both", "all, including those that face away"},
  }};
};

/// How visibility between a skeleton node and light vertices is determined.
enum class NodeVisibilityTest { rays, node_maps };

template <>
struct EnumTable<NodeVisibilityTest> {
  static constexpr std::array<EnumValue<NodeVisibilityTest>, 2> values{{
      {NodeVisibilityTest::rays, "rays", "by a shadow ray to each, in each iteration"},
      {NodeVisibilityTest::node_maps, "node_maps",
       "by a cube map of depths around the node, rendered once and stored on disk (Noel 2015, "
       "11.6). Errors at edges between texels affect probabilities only, not the expected picture"},
  }};
};

/// Settings common to all connection strategies except `paired`.
struct ResamplingSettings {
  int light_paths = 1024;
  // These differ from the published values, see their tables:
  int count_as = 8;
  double splat_paths = 0.25;
  double roulette = 0.3;
  bool operator==(const ResamplingSettings&) const = default;
};

/// `published_count`: the published value of `count_as`.
template <class V>
void describe_resampling(V& v, ResamplingSettings& s, std::string_view published_count = "0") {
  v("light_paths", s.light_paths,
    {.doc = "light paths per iteration that eye paths are connected to, shared by all pixels",
     .min = 1,
     .max = 1 << 16});
  v("splat_paths", s.splat_paths,
    {.doc = "light paths per iteration that are connected to the eye (t = 1), as a fraction of the "
            "pixels; at least light_paths",
     .min = 0,
     .max = 16,
     .published = "1"});
  v("count_as", s.count_as,
    {.doc = "number of samples n_s that MIS weights assume for connections to resampled light "
            "paths of two or more vertices (s >= 2); for s = 1, a point on an emitter, they assume "
            "1. 0: light_paths in both cases (Noel 2015, 11.5)",
     .min = 0,
     .max = 1 << 16,
     .published = published_count});
  v("roulette", s.roulette,
    {.doc = "Russian roulette of connections: a connection is made with a probability proportional "
            "to the root mean square contribution of earlier connections of the same length in the "
            "same cell of the empty space. The probability reaches 1 at this fraction of the mean "
            "contribution of all connections of a path in the tile. 0: all connections are made",
     .min = 0,
     .max = 1,
     .published = "0"});
}

/// The shadow rays of a pixel's connections.
enum class ConnectionRays { all, one };

template <>
struct EnumTable<ConnectionRays> {
  static constexpr std::array<EnumValue<ConnectionRays>, 2> values{{
      {ConnectionRays::all, "all", "one for each connection"},
      {ConnectionRays::one, "one",
       "one for each eye path: a connection sampled in proportion to its unoccluded contribution "
       "stands for all, but those to the eye (Noel 2015, 4.3.2.2)"},
  }};
};

/// connections: paired.
struct PairedSettings {
  static constexpr std::string_view name = "paired";
  static constexpr std::string_view doc =
      "every eye path is connected to its own light path and, at each vertex, to a new point on an "
      "emitter";
  EmitterChoice emitters = EmitterChoice::automatic;
  DirectPoint direct = DirectPoint::new_point;  // differs from the published value
  ConnectionRays rays = ConnectionRays::all;
  bool operator==(const PairedSettings&) const = default;
};
template <class V>
void describe(V& v, PairedSettings& s) {
  describe_emitters(v, s.emitters);
  describe_direct_point(v, s.direct);
  v("rays", s.rays, {.doc = "the shadow rays of connections"});
}

/// connections: uniform.
struct UniformSettings : ResamplingSettings {
  static constexpr std::string_view name = "uniform";
  static constexpr std::string_view doc =
      "for each path length, one of the shared light vertices, all with equal probability";
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
      "light vertices resampled by distributions at the skeleton's nodes (Noel 2015, ch. 11)";

  double acceptance = 1;
  bool visible = true;
  NodeVisibilityTest node_visibility = NodeVisibilityTest::rays;
  int map_size = node_map_size;
  bool unshadowed = true;
  // These differ from the published values, see their tables:
  Combination combination = Combination::mixture;
  LightSides sides = LightSides::facing;
  bool operator==(const SkeletonConnectionsSettings&) const = default;
};
template <class V, class S>
void describe_acceptance(V& v, S& s) {
  v("acceptance", s.acceptance,
    {.doc =
         "a node has distributions if in earlier iterations its number of eye vertices was at "
         "least this times the mean over all nodes; elsewhere light vertices are sampled uniformly",
     .min = 0,
     .max = 1e6});
}
template <class V>
void describe(V& v, SkeletonConnectionsSettings& s) {
  describe_resampling(v, s);
  describe_acceptance(v, s);
  v("visible", s.visible,
    {.doc = "distribution V: throughput over squared distance of the light vertices that the node "
            "sees (eq. 188)"});
  v("node_visibility", s.node_visibility,
    {.doc = "how V determines which light vertices the node sees"});
  describe_node_map_size(v, s.map_size);
  v("unshadowed", s.unshadowed,
    {.doc = "distribution U: the same for all light vertices, without visibility (eq. 189)"});
  v("combination", s.combination,
    {.doc = "how V, U and the uniform distribution C are combined", .published = "\"max\""});
  v("sides", s.sides, {.doc = "light vertices that V and U include", .published = "\"both\""});
}

/// connections: importance_cache.
struct ImportanceCacheSettings : ResamplingSettings {
  static constexpr std::string_view name = "importance_cache";
  static constexpr std::string_view doc =
      "light vertices resampled by distributions at records on surfaces (Georgiev et al. 2012)";

  double record_density = 0.001;
  int neighbours = 3;
  bool full = true;
  bool unshadowed = false;
  bool bounded = false;
  Combination combination = Combination::mixture;  // differs from the published value
  bool operator==(const ImportanceCacheSettings&) const = default;
};
template <class V, class S>
void describe_records(V& v, S& s) {
  v("record_density", s.record_density,
    {.doc = "eye paths whose vertices become records, as a fraction of the pixels",
     .min = 0,
     .max = 0.1,
     .above_min = true});
  v("neighbours", s.neighbours,
    {.doc = "number of nearest records of an eye vertex; one of them, selected at random, samples "
            "the light vertices",
     .min = 1,
     .max = 64});
}
template <class V>
void describe(V& v, ImportanceCacheSettings& s) {
  describe_resampling(v, s);
  describe_records(v, s);
  v("full", s.full, {.doc = "distribution F: the contribution to the record, with visibility"});
  v("unshadowed", s.unshadowed, {.doc = "distribution U: the same without visibility"});
  v("bounded", s.bounded,
    {.doc = "distribution B: without visibility, the record's BSDF and the distance, which are "
            "valid only at the record itself"});
  v("combination", s.combination,
    {.doc = "how F, U, B and the uniform distribution C are combined", .published = "\"max\""});
}

/// connections: probabilistic.
struct ProbabilisticConnectionsSettings : ResamplingSettings {
  static constexpr std::string_view name = "probabilistic";
  static constexpr std::string_view doc =
      "for each eye vertex, light vertices of any path length, sampled in proportion to their "
      "contributions to records on surfaces, including MIS weights (Popov et al. 2015)";

  /// The cost of an iteration's distributions is proportional to records times light paths.
  ProbabilisticConnectionsSettings() { light_paths = 256; }

  double record_density = ImportanceCacheSettings{}.record_density;
  int neighbours = ImportanceCacheSettings{}.neighbours;
  int draws = 1;
  double uniform = 0.2;
  bool weighted = true;
  bool operator==(const ProbabilisticConnectionsSettings&) const = default;
};
template <class V>
void describe(V& v, ProbabilisticConnectionsSettings& s) {
  describe_resampling(v, s, "1");
  describe_records(v, s);
  v("draws", s.draws,
    {.doc = "connections per eye vertex, to light vertices of any path length",
     .min = 1,
     .max = 64});
  v("uniform", s.uniform,
    {.doc = "fraction of the samples for which all light vertices are equally probable",
     .min = 0.01,
     .max = 1});
  v("weighted", s.weighted,
    {.doc = "the contributions to a record include the MIS weights of the connections"});
}

/// connections: hybrid. Records are dense on visible surfaces and sparse elsewhere; skeleton nodes
/// cover all of the empty space.
struct HybridSettings : ResamplingSettings {
  static constexpr std::string_view name = "hybrid";
  static constexpr std::string_view doc =
      "importance_cache at the first vertices of an eye path, skeleton at later ones (Noel 2015, "
      "11.6)";

  int cached_depth = 1;
  double record_density = ImportanceCacheSettings{}.record_density;
  int neighbours = ImportanceCacheSettings{}.neighbours;
  double acceptance = SkeletonConnectionsSettings{}.acceptance;
  Combination combination = Combination::mixture;  // differs from the published value
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
    {.doc = "eye vertices at most this number of edges from the eye use records",
     .min = 1,
     .max = 1024,
     .unit = "edges"});
  describe_records(v, s);
  describe_acceptance(v, s);
  v("combination", s.combination,
    {.doc = "how F and C at records, and V, U and C at nodes, are combined",
     .published = "\"max\""});
}

/// How light vertices are sampled for an eye vertex.
using ConnectionsSettings =
    std::variant<PairedSettings, UniformSettings, SkeletonConnectionsSettings,
                 ImportanceCacheSettings, ProbabilisticConnectionsSettings, HybridSettings>;

}  // namespace lacuna
