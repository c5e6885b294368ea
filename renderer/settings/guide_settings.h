#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "base/settings/auto_number.h"
#include "base/settings/field.h"
#include "renderer/settings/bias.h"
#include "renderer/settings/departures.h"

namespace lacuna {

/// guide: bsdf. The next direction is sampled from the BSDF.
struct BsdfGuideSettings {
  static constexpr std::string_view name = "bsdf";
  static constexpr std::string_view doc = "directions are sampled from the BSDF only";
  bool operator==(const BsdfGuideSettings&) const = default;
};
template <class V>
void describe(V&, BsdfGuideSettings&) {}

/// Largest probability of a guide relative to the BSDF. 1 is not allowed: the BSDF must sample the
/// directions that the guide never samples.
inline constexpr double most_guided = 0.9;

/// The point, on the visible part of a shortest path, at which rays are aimed.
enum class ImportanceAim { last, tightest, mean };

template <>
struct EnumTable<ImportanceAim> {
  static constexpr std::array<EnumValue<ImportanceAim>, 3> values{{
      {ImportanceAim::last, "last", "the last visible node"},
      {ImportanceAim::tightest, "tightest",
       "the node whose ball subtends the smallest angle: the bottleneck that all rays pass"},
      {ImportanceAim::mean, "mean", "the mean position of its nodes (Noel 2015, eq. 162)"},
  }};
};

/// Settings of guides that trace rays from the lights to find lit surfaces (Noel 2015, eq. 176).
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
  AutoNumber probability;
  // These differ from the published values, see their tables:
  ImportanceAim aim = ImportanceAim::last;
  GuidedRoulette roulette = GuidedRoulette::window;
  bool operator==(const SkeletonGuideSettings&) const = default;
};
template <class V>
void describe(V& v, SkeletonGuideSettings& s) {
  v("strength", s.strength,
    {.doc = "exponent of the power-cosine lobes; 0: uniform over the hemisphere (eq. 163); "
            "\"auto\": a mixture of powers of two, learned for each node while rendering",
     .min = 0,
     .max = 10000});
  v("probability", s.probability,
    {.doc = "probability of sampling a direction from the lobes instead of the BSDF (c_skel, 9.4); "
            "\"auto\": learned for each node while rendering",
     .min = 0,
     .max = most_guided,
     .published = "0.5"});
  v("aim", s.aim,
    {.doc = "the point on the visible part of a shortest path that rays are aimed at",
     .published = "\"mean\""});
  describe_light_rays(
      v, s, "rays from the lights that estimate the power arriving at each node (eq. 176)");
  describe_guided_roulette(v, s.roulette);
}

/// Settings of guides that use the regions of the opening forest labelling.
struct RegionGuideSettings {
  AutoNumber probability;
  int mixing = 4;
  bool guide_only = false;
  /// A point in the coordinates of the scene's file: it selects the faces for all regions.
  std::optional<std::array<double, 3>> through;
  GuidedRoulette roulette = GuidedRoulette::window;  // differs from the published value
  bool biased() const { return guide_only; }
  bool operator==(const RegionGuideSettings&) const = default;
};

/// `through`: the documentation of that field; each guide selects other faces by it.
template <class V>
void describe_region_guide(V& v, RegionGuideSettings& s, const char* through) {
  v("probability", s.probability,
    {.doc = "probability of sampling a direction through a face instead of from the BSDF; "
            "\"auto\": learned for each region while rendering",
     .min = 0,
     .max = most_guided,
     .published = "0.5"});
  v("mixing", s.mixing,
    {.doc = "distance over which the distributions of neighbouring regions are interpolated; 0: no "
            "interpolation, which makes borders visible in the noise",
     .min = 0,
     .max = 64,
     .unit = "voxels",
     .published = "0"});
  v("guide_only", s.guide_only,
    {.doc = "never sample the BSDF in a region that has a distribution, regardless of "
            "`probability`: biased, because light that does not arrive through its faces is missed "
            "(Noel 2015, 10.4, SIS1 and FIS1)"});
  v("through", s.through, {.doc = through, .min = -1e15, .max = 1e15});
  describe_guided_roulette(v, s.roulette);
}

/// The portal, on a shortest path, that rays are sent through.
enum class PortalChoice { last, next };

template <>
struct EnumTable<PortalChoice> {
  static constexpr std::array<EnumValue<PortalChoice>, 2> values{{
      {PortalChoice::last, "last", "the last portal that the region's centre sees"},
      {PortalChoice::next, "next", "the first portal, on the region's border (Noel 2015, 10.4.1)"},
  }};
};

/// guide: portals.
struct PortalsGuideSettings : RegionGuideSettings, LightRays {
  static constexpr std::string_view name = "portals";
  static constexpr std::string_view doc =
      "rays through the portals on the shortest paths to where the light arrives (Noel 2015, "
      "10.4.1)";
  // These differ from the published values, see their tables:
  PortalChoice portal = PortalChoice::last;
  PortalPaths paths = PortalPaths::lit_regions;
  bool operator==(const PortalsGuideSettings&) const = default;
};
template <class V>
void describe(V& v, PortalsGuideSettings& s) {
  describe_region_guide(v, s,
                        "a point of the empty space, in the coordinates of the scene's file: all "
                        "guided rays, of every region, go through the portal nearest to it (Noel "
                        "2015, 10.4.1, SIS3 and SIS4), and `portal`, `paths` and `light_rays` "
                        "have no effect");
  v("portal", s.portal,
    {.doc = "the portal on a shortest path that rays are sent through", .published = "\"next\""});
  describe_portal_paths(v, s.paths);
  describe_light_rays(v, s, "rays from the lights that estimate the power arriving in each region");
}

/// guide: face_irradiance.
struct FaceIrradianceGuideSettings : RegionGuideSettings {
  static constexpr std::string_view name = "face_irradiance";
  static constexpr std::string_view doc =
      "rays through the faces of a region's border, in proportion to the light that arrives "
      "through each (Noel 2015, 10.4.2)";
  // These differ from the published values, see their tables:
  double least_distance = 0;
  double least_cosine = 0;
  FacePaths learn_from = FacePaths::eye;
  bool operator==(const FaceIrradianceGuideSettings&) const = default;
};
template <class V>
void describe(V& v, FaceIrradianceGuideSettings& s) {
  describe_region_guide(v, s,
                        "a point of the empty space, in the coordinates of the scene's file: all "
                        "guided rays, of every region, go through faces of the border of the "
                        "region that it lies in (Noel 2015, 10.4.2, FIS3 and FIS4)");
  v("least_distance", s.least_distance,
    {.doc = "if the centre of the selected face is closer than this fraction of the diagonal of "
            "the scene's box, a face of the border of the region behind it is used instead (d_t, "
            "10.4.2); 0: never",
     .min = 0,
     .max = 1,
     .published = "0.01"});
  v("least_cosine", s.least_cosine,
    {.doc = "the same if the cosine between the face's normal and the direction to its centre is "
            "below this (o_t); 0: never",
     .min = 0,
     .max = 1,
     .published = "0.5"});
  describe_face_paths(v, s.learn_from);
}

/// guide: sd_tree.
struct SdTreeGuideSettings {
  static constexpr std::string_view name = "sd_tree";
  static constexpr std::string_view doc =
      "practical path guiding: incident radiance learned in a tree over positions and directions "
      "(Mueller et al. 2017)";
  AutoNumber probability{0.5};  // as published
  int leaf_vertices = 4000;
  GuidedRoulette roulette = GuidedRoulette::window;  // differs from the published value
  bool operator==(const SdTreeGuideSettings&) const = default;
};
template <class V>
void describe(V& v, SdTreeGuideSettings& s) {
  v("probability", s.probability,
    {.doc =
         "probability of sampling a direction from the tree instead of the BSDF; \"auto\": learned "
         "for each leaf while rendering",
     .min = 0,
     .max = most_guided});
  v("leaf_vertices", s.leaf_vertices,
    {.doc = "number of vertices above which a leaf of the spatial tree is split after the first "
            "iteration (c of the paper)",
     .min = 1,
     .max = 1 << 30});
  describe_guided_roulette(v, s.roulette);
}

/// guide: learned_skeleton.
struct LearnedSkeletonGuideSettings : LightRays {
  static constexpr std::string_view name = "learned_skeleton";
  static constexpr std::string_view doc =
      "incident radiance learned in cells of the empty space, initialised by the skeleton's lobes";
  AutoNumber probability;
  int leaf_vertices = 4000;
  bool operator==(const LearnedSkeletonGuideSettings&) const = default;
};
template <class V>
void describe(V& v, LearnedSkeletonGuideSettings& s) {
  v("probability", s.probability,
    {.doc = "probability of sampling a direction from the guide instead of the BSDF; \"auto\": "
            "learned for each cell while rendering",
     .min = 0,
     .max = most_guided});
  v("leaf_vertices", s.leaf_vertices,
    {.doc = "number of vertices above which a cell is split after the first iteration",
     .min = 1,
     .max = 1 << 30});
  describe_light_rays(v, s,
                      "rays from the lights that estimate the power arriving at each node, for the "
                      "lobes of the first iterations");
}

/// How the next direction of an eye path is sampled. A new guide is a further alternative here.
using GuideSettings =
    std::variant<BsdfGuideSettings, SkeletonGuideSettings, PortalsGuideSettings,
                 FaceIrradianceGuideSettings, SdTreeGuideSettings, LearnedSkeletonGuideSettings>;

}  // namespace lacuna
