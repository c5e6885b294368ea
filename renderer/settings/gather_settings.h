#pragma once

#include <string_view>
#include <variant>

#include "analysis/settings/field.h"

namespace lacuna {

/// gather: all.
struct AllLightsSettings {
  static constexpr std::string_view name = "all";
  static constexpr std::string_view doc = "every one of them";
  bool operator==(const AllLightsSettings&) const = default;
};
template <class V>
void describe(V&, AllLightsSettings&) {}

/// gather: random.
struct RandomLightsSettings {
  static constexpr std::string_view name = "random";
  static constexpr std::string_view doc =
      "a few drawn for each, all alike probable, and so that they lie far apart (Kol et al. 2018, "
      "5.1)";

  int lights = 64;
  bool cull = true;
  double cutoff = 0;
  int filter_radius = 0;
  double filter_normal = 32;
  double filter_slope = 0.1;

  /// Neighbouring pixels' light is mixed in, or far lights' is left out.
  bool biased() const { return filter_radius > 0 || cutoff > 0; }
  bool operator==(const RandomLightsSettings&) const = default;
};
template <class V>
void describe(V& v, RandomLightsSettings& s) {
  v("lights", s.lights, {.doc = "for each shading point", .min = 1, .max = 1 << 20});
  v("cull", s.cull,
    {.doc =
         "none is drawn from a stretch of lights that all turn away from the point or lie behind "
         "it"});
  v("cutoff", s.cutoff,
    {.doc = "lights further from the point than this shine on it no more; 0: all do. Less noise, "
            "and biased",
     .min = 0,
     .max = 1e15,
     .unit = "scene units"});
  v("filter_radius", s.filter_radius,
    {.doc =
         "pixels; 0: none. What lights give, divided by what the surface reflects, becomes the "
         "mean over a square of pixels with surfaces alike (cross-bilateral filter): less noise, "
         "and biased",
     .min = 0,
     .max = 32});
  v("filter_normal", s.filter_normal,
    {.doc = "a pixel counts by the cosine between its normal and the middle one's to this power",
     .min = 0,
     .max = 1024});
  v("filter_slope", s.filter_slope,
    {.doc =
         "a pixel whose surface lies off the middle one's plane, over the distance between both, "
         "as much as this counts e^-1/2",
     .min = 0.001,
     .max = 10});
}

/// Which virtual lights a shading point meets.
using GatherSettings = std::variant<AllLightsSettings, RandomLightsSettings>;

}  // namespace lacuna
