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
inline constexpr double most_guided = 0.9;

/// Where on the visible part of a shortest path rays are sent.
enum class ImportanceAim { last, tightest, mean };

template <>
struct EnumTable<ImportanceAim> {
  static constexpr std::array<EnumValue<ImportanceAim>, 3> values{{
      {ImportanceAim::last, "last", "the last node that is seen"},
      {ImportanceAim::tightest, "tightest",
       "the node whose ball looks smallest: the bottleneck that all rays have to pass"},
      {ImportanceAim::mean, "mean", "the mean of all (Noel 2015, eq. 162)"},
  }};
};

/// What guides that look for where light arrives (Noel 2015, eq. 176) have in common.
struct LightRays {
  int light_rays = 1 << 16;
  bool operator==(const LightRays&) const = default;
};

template <class V>
void describe_light_rays(V& v, LightRays& s, const char* doc) {
  v("light_rays", s.light_rays, {.doc = doc, .min = 1, .max = 1 << 20});
}

/// guide: skeleton.
struct SkeletonGuideSettings : LightRays {
  static constexpr std::string_view name = "skeleton";
  static constexpr std::string_view doc =
      "rays towards the light along the skeleton of the empty space (Noel 2015, ch. 9)";

  AutoNumber strength{8};
  AutoNumber probability{0.5};
  ImportanceAim aim = ImportanceAim::last;  // as published it is otherwise
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
  v("aim", s.aim,
    {.doc = "where rays are sent on the visible part of a shortest path", .published = "\"mean\""});
  describe_light_rays(
      v, s, "rays from the lights that find the nodes whose surroundings are lit (eq. 176)");
}

/// What guides by the regions of the opening forest labelling have in common.
struct RegionGuideSettings {
  AutoNumber probability;
  int mixing = 4;
  bool operator==(const RegionGuideSettings&) const = default;
};

template <class V>
void describe_region_guide(V& v, RegionGuideSettings& s) {
  v("probability", s.probability,
    {.doc = "share of directions drawn through faces instead of from the BSDF; \"auto\": learned "
            "for each region while rendering",
     .min = 0,
     .max = most_guided});
  v("mixing", s.mixing,
    {.doc = "over how far a region's way of drawing turns into its neighbour's; 0: at once, which "
            "shows as a border in the picture's noise",
     .min = 0,
     .max = 64,
     .unit = "voxels"});
}

/// Which portal on a shortest path rays are sent through.
enum class PortalChoice { last, next };

template <>
struct EnumTable<PortalChoice> {
  static constexpr std::array<EnumValue<PortalChoice>, 2> values{{
      {PortalChoice::last, "last", "the last one that the region's centre sees"},
      {PortalChoice::next, "next", "the region's own (Noel 2015, 10.4.1)"},
  }};
};

/// guide: portals.
struct PortalsGuideSettings : RegionGuideSettings, LightRays {
  static constexpr std::string_view name = "portals";
  static constexpr std::string_view doc =
      "rays through the portals on the shortest paths to where the light arrives (Noel 2015, "
      "10.4.1)";
  PortalChoice portal = PortalChoice::last;  // as published it is otherwise
  bool operator==(const PortalsGuideSettings&) const = default;
};
template <class V>
void describe(V& v, PortalsGuideSettings& s) {
  describe_region_guide(v, s);
  v("portal", s.portal,
    {.doc = "which portal on a shortest path rays are sent through", .published = "\"next\""});
  describe_light_rays(v, s, "rays from the lights that find the regions that are lit");
}

/// guide: face_irradiance.
struct FaceIrradianceGuideSettings : RegionGuideSettings {
  static constexpr std::string_view name = "face_irradiance";
  static constexpr std::string_view doc =
      "rays through the faces of a region's border, by the light that was seen through each (Noel "
      "2015, 10.4.2)";
  bool operator==(const FaceIrradianceGuideSettings&) const = default;
};
template <class V>
void describe(V& v, FaceIrradianceGuideSettings& s) {
  describe_region_guide(v, s);
}

/// guide: sd_tree.
struct SdTreeGuideSettings {
  static constexpr std::string_view name = "sd_tree";
  static constexpr std::string_view doc =
      "rays to where paths before found light, learned in a tree over places and directions "
      "(Mueller et al. 2017)";
  double probability = 0.5;
  int leaf_vertices = 4000;
  bool operator==(const SdTreeGuideSettings&) const = default;
};
template <class V>
void describe(V& v, SdTreeGuideSettings& s) {
  v("probability", s.probability,
    {.doc = "share of directions drawn from the tree instead of the BSDF",
     .min = 0,
     .max = most_guided});
  v("leaf_vertices", s.leaf_vertices,
    {.doc = "vertices in the first iteration beyond which a place is divided",
     .min = 1,
     .max = 1 << 30});
}

/// Where the next ray of a path from the eye goes. A new guide is one more alternative here.
using GuideSettings = std::variant<BsdfGuideSettings, SkeletonGuideSettings, PortalsGuideSettings,
                                   FaceIrradianceGuideSettings, SdTreeGuideSettings>;

}  // namespace lacuna
