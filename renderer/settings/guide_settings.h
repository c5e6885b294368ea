#pragma once

#include <array>
#include <string_view>
#include <variant>

#include "analysis/settings/auto_number.h"
#include "analysis/settings/field.h"

namespace lacuna {

/// guide: bsdf. The next ray follows the surface's own scattering.
struct BsdfGuideSettings {
  static constexpr std::string_view name = "bsdf";
  static constexpr std::string_view doc = "directions drawn from the BSDF alone";
  bool operator==(const BsdfGuideSettings&) const = default;
};
template <class V>
void describe(V&, BsdfGuideSettings&) {}

/// Of directions drawn from a guide that are mixed with the BSDF's. 1 is not allowed: where the
/// guide never looks, only the BSDF does.
inline constexpr double most_guided = 0.95;

/// Where on the visible part of a shortest path rays are sent.
enum class ImportanceAim { tightest, last, mean };

template <>
struct EnumTable<ImportanceAim> {
  static constexpr std::array<EnumValue<ImportanceAim>, 3> values{{
      {ImportanceAim::tightest, "tightest",
       "the node whose ball looks smallest: the bottleneck that all rays have to pass"},
      {ImportanceAim::last, "last", "the last node that is seen"},
      {ImportanceAim::mean, "mean", "the mean of all (Noel 2015, eq. 162)"},
  }};
};

/// guide: skeleton.
struct SkeletonGuideSettings {
  static constexpr std::string_view name = "skeleton";
  static constexpr std::string_view doc =
      "rays towards the light along the skeleton of the empty space (Noel 2015, ch. 9)";

  AutoNumber strength{8};
  AutoNumber probability{0.5};
  ImportanceAim aim = ImportanceAim::tightest;
  int light_rays = 1 << 16;
  bool operator==(const SkeletonGuideSettings&) const = default;
};
template <class V>
void describe(V& v, SkeletonGuideSettings& s) {
  v("strength", s.strength,
    {.doc = "exponent of the power-cosine lobes, 0: half the sphere (eq. 163); \"auto\": learned "
            "for each node while rendering",
     .min = 0,
     .max = 10000});
  v("probability", s.probability,
    {.doc = "share of directions drawn from the lobes instead of the BSDF (c_skel, 9.4); \"auto\": "
            "learned for each node while rendering",
     .min = 0,
     .max = most_guided});
  v("aim", s.aim, {.doc = "where rays are sent on the visible part of a shortest path"});
  v("light_rays", s.light_rays,
    {.doc = "rays from the lights that find the nodes whose surroundings are lit (eq. 176)",
     .min = 1,
     .max = 1 << 26});
}

/// Where the next ray of a path from the eye goes. A new guide is one more alternative here.
using GuideSettings = std::variant<BsdfGuideSettings, SkeletonGuideSettings>;

}  // namespace lacuna
