#pragma once

#include <string_view>
#include <variant>

#include "base/settings/field.h"

namespace lacuna {

/// gather: all.
struct AllLightsSettings {
  static constexpr std::string_view name = "all";
  static constexpr std::string_view doc = "every virtual light";
  static bool biased() { return false; }
  bool operator==(const AllLightsSettings&) const = default;
};
template <class V>
void describe(V&, AllLightsSettings&) {}

/// What is culled before lights are sampled.
enum class CullFor { points, cubes };

template <>
struct EnumTable<CullFor> {
  static constexpr std::array<EnumValue<CullFor>, 2> values{{
      {CullFor::points, "points",
       "groups of lights for each shading point: they face away from it or lie behind its surface"},
      {CullFor::cubes, "cubes",
       "nodes of an octree of the lights for each cube of an octree of the scene, both of 64^3 "
       "cubes, by traversing them together (Kol et al. 2018, 5.1): they face away from the cube"},
  }};
};

/// gather: random.
struct RandomLightsSettings {
  static constexpr std::string_view name = "random";
  static constexpr std::string_view doc =
      "a few virtual lights for each shading point, with equal probability, by systematic sampling "
      "in the lights' spatial order (Kol et al. 2018, 5.1)";

  int lights = 64;
  int interleave = 0;
  bool cull = true;
  CullFor cull_for = CullFor::points;
  double cutoff = 0;
  int filter_radius = 0;
  double filter_normal = 32;
  double filter_slope = 0.1;

  /// The filter blends light of neighbouring pixels; the cutoff omits distant lights.
  bool biased() const { return filter_radius > 0 || cutoff > 0; }
  bool operator==(const RandomLightsSettings&) const = default;
};
template <class V>
void describe(V& v, RandomLightsSettings& s) {
  v("lights", s.lights,
    {.doc = "virtual lights for each shading point. The number of cache points of a visibility is "
            "limited so that they test at most a quarter as many lights as the shading points",
     .min = 1,
     .max = 1 << 20});
  v("interleave", s.interleave,
    {.doc = "side of a pattern of pixels that divide the lights among them: each gathers every "
            "interleave^2-th group of up to 64 neighbouring lights, in place of `lights` "
            "(interleaved shading; Noel 2015, 8.5). 0: none. Not with `cull_for` cubes",
     .min = 0,
     .max = 64,
     .unit = "pixels"});
  v("cull", s.cull,
    {.doc = "omit groups of lights that all face away from the shading point or lie behind its "
            "surface, or of `cull_for`"});
  v("cull_for", s.cull_for,
    {.doc = "what groups of lights are culled for", .published = "\"cubes\""});
  v("cutoff", s.cutoff,
    {.doc = "ignore lights further from the shading point than this; 0: no limit. Less noise, but "
            "biased",
     .min = 0,
     .max = 1e15,
     .unit = "scene units"});
  v("filter_radius", s.filter_radius,
    {.doc =
         "radius of the cross-bilateral filter in pixels; 0: none. The light of the virtual "
         "lights, "
         "divided by the surface's reflectance, is averaged over a square of pixels with similar "
         "surfaces: less noise, but biased",
     .min = 0,
     .max = 32});
  v("filter_normal", s.filter_normal,
    {.doc = "filter weight of a pixel: this power of the cosine between its normal and the normal "
            "at the centre",
     .min = 0,
     .max = 1024});
  v("filter_slope", s.filter_slope,
    {.doc = "filter weight of a pixel: e^-1/2 where its distance to the centre's tangent plane is "
            "this "
            "share of its distance to the centre",
     .min = 0.001,
     .max = 10});
}

/// gather: lightcuts.
struct LightcutsSettings {
  static constexpr std::string_view name = "lightcuts";
  static constexpr std::string_view doc =
      "clusters of virtual lights, a cut through a light tree for each shading point, each by one "
      "light of it that stands for all (biased; Walter et al. 2005)";

  double error = 0.02;
  int most = 1000;

  static bool biased() { return true; }
  bool operator==(const LightcutsSettings&) const = default;
};
template <class V>
void describe(V& v, LightcutsSettings& s) {
  v("error", s.error,
    {.doc = "clusters are divided until the largest possible error of one is below this share of "
            "the light at the shading point",
     .min = 0,
     .max = 1});
  v("most", s.most, {.doc = "clusters for each shading point, at most", .min = 1, .max = 1 << 20});
}

/// gather: clusters.
struct ClusterLightsSettings {
  static constexpr std::string_view name = "clusters";
  static constexpr std::string_view doc =
      "a few virtual lights for each shading point, by importance: clusters of a cut through a "
      "light tree, one cut for 8 x 8 pixels, are sampled by their estimated contribution and by "
      "the learned rate of visibility of `visibility` `probabilistic`";

  int lights = 64;
  int nodes = 512;
  double power_share = 0.1;

  static bool biased() { return false; }
  bool operator==(const ClusterLightsSettings&) const = default;
};
template <class V>
void describe(V& v, ClusterLightsSettings& s) {
  v("lights", s.lights, {.doc = "virtual lights for each shading point", .min = 1, .max = 1 << 20});
  v("nodes", s.nodes,
    {.doc = "clusters of a cut; at least one for each length of light paths and kind of light",
     .min = 1,
     .max = 1 << 16});
  v("power_share", s.power_share,
    {.doc = "share of the lights that are sampled by power, whatever their estimate",
     .min = 0,
     .max = 1,
     .above_min = true});
}

/// Which virtual lights are gathered at a shading point.
using GatherSettings =
    std::variant<AllLightsSettings, RandomLightsSettings, LightcutsSettings, ClusterLightsSettings>;

}  // namespace lacuna
