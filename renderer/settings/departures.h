#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

// Departures of the renderer from the published methods that change an algorithm, not a number:
// one setting each. The default is this project's choice; Field::published undoes it, as
// {"as": "published"} does for all settings of an object (jobs/spec/published.h). Declared
// elsewhere, because their tables have further values: Sampler, VarianceOf, NodeRadius.

/// How guided eye paths are ended and split.
enum class GuidedRoulette { window, throughput };

template <>
struct EnumTable<GuidedRoulette> {
  static constexpr std::array<EnumValue<GuidedRoulette>, 2> values{{
      {GuidedRoulette::window, "window",
       "they are split, and ended after `roulette_depth` edges, such that their expected further "
       "contribution stays within a window (Vorba and Krivanek 2016)"},
      {GuidedRoulette::throughput, "throughput",
       "they are never split, and ended like paths without a guide"},
  }};
};

template <class V>
void describe_guided_roulette(V& v, GuidedRoulette& s) {
  v("roulette", s,
    {.doc = "how guided eye paths are ended and split", .published = "\"throughput\""});
}

/// How the two techniques of path tracing are weighted.
enum class Heuristic { power, balance };

template <>
struct EnumTable<Heuristic> {
  static constexpr std::array<EnumValue<Heuristic>, 2> values{{
      {Heuristic::power, "power", "with exponent 2 (Veach 1997, 9.2.4)"},
      {Heuristic::balance, "balance", "(Noel 2015, eq. 119)"},
  }};
};

template <class V>
void describe_heuristic(V& v, Heuristic& s) {
  v("heuristic", s,
    {.doc = "how emitters hit by a path and points sampled on emitters are weighted",
     .published = "\"balance\""});
}

/// The regions to which shortest paths through portals lead.
enum class PortalPaths { lit_regions, light_region };

template <>
struct EnumTable<PortalPaths> {
  static constexpr std::array<EnumValue<PortalPaths>, 2> values{{
      {PortalPaths::lit_regions, "lit_regions",
       "all regions at which light arrives, weighted by its power over the squared length; light "
       "that arrives in the region itself lowers the probability of the guide"},
      {PortalPaths::light_region, "light_region",
       "the one region from which the emitters emit the most power; inside it, the BSDF is sampled "
       "(Noel 2015, 10.4.1)"},
  }};
};

template <class V>
void describe_portal_paths(V& v, PortalPaths& s) {
  v("paths", s,
    {.doc = "the regions that shortest paths lead to", .published = "\"light_region\""});
}

/// The point on an emitter that an eye vertex of paired bidirectional path tracing is connected to.
enum class DirectPoint { new_point, light_path };

template <>
struct EnumTable<DirectPoint> {
  static constexpr std::array<EnumValue<DirectPoint>, 2> values{{
      {DirectPoint::new_point, "new_point", "a new one for each eye vertex, by `emitters`"},
      {DirectPoint::light_path, "light_path",
       "the first vertex of the light path, the same for all eye vertices (Noel 2015, 4.3); "
       "`emitters` has no effect"},
  }};
};

template <class V>
void describe_direct_point(V& v, DirectPoint& s) {
  v("direct", s,
    {.doc = "the point on an emitter that an eye vertex is connected to (s = 1)",
     .published = "\"light_path\""});
}

/// The paths from which face irradiance is learned.
enum class FacePaths { eye, face };

template <>
struct EnumTable<FacePaths> {
  static constexpr std::array<EnumValue<FacePaths>, 2> values{{
      {FacePaths::eye, "eye", "the eye paths that leave a region through the face"},
      {FacePaths::face, "face",
       "one path from each face before each iteration, sampled by the BSDF (Noel 2015, 10.4.2)"},
  }};
};

template <class V>
void describe_face_paths(V& v, FacePaths& s) {
  v("learn_from", s,
    {.doc = "the paths that estimate the light arriving through a face", .published = "\"face\""});
}

}  // namespace lacuna
