#pragma once

#include <array>
#include <string_view>

#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The quantity that integrator `inspect` shows.
enum class InspectQuantity {
  normal,
  albedo,
  depth,
  emission,
  node_mapping,
  filtered_mapping,
  opening,
  region_labels,
  visibility_clusters,
  nearest_node_visible,
  guide_density,
  guide_cells,
  guide_probability
};

template <>
struct EnumTable<InspectQuantity> {
  static constexpr std::array<EnumValue<InspectQuantity>, 13> values{{
      {InspectQuantity::normal, "normal", "shading normal, world space, components in [-1, 1]"},
      {InspectQuantity::albedo, "albedo", "base reflectance"},
      {InspectQuantity::depth, "depth", "distance from the eye, scene units"},
      {InspectQuantity::emission, "emission", "radiance emitted towards the eye"},
      {InspectQuantity::node_mapping, "node_mapping",
       "the skeleton node that the surface belongs to, one colour per node"},
      {InspectQuantity::filtered_mapping, "filtered_mapping", "the same for the filtered skeleton"},
      {InspectQuantity::opening, "opening",
       "half the side of the largest cube of empty space that contains the voxel in front of the "
       "surface, scene units"},
      {InspectQuantity::region_labels, "region_labels",
       "the region of the opening forest labelling, one colour per region"},
      {InspectQuantity::visibility_clusters, "visibility_clusters",
       "the visibility cluster of the surface's node, one colour per cluster"},
      {InspectQuantity::nearest_node_visible, "nearest_node_visible",
       "green where the surface and its node are mutually visible, red where they are not, black "
       "where it has no node"},
      {InspectQuantity::guide_density, "guide_density",
       "density per steradian of the guide's directions from the point `from` to the surface; "
       "black "
       "where the surface is occluded from it"},
      {InspectQuantity::guide_cells, "guide_cells",
       "the cell of the guide that the surface lies in, one colour per cell, black where it has "
       "none"},
      {InspectQuantity::guide_probability, "guide_probability",
       "the probability of sampling a direction from the guide instead of the BSDF"},
  }};
};

/// Whether the quantity belongs to the analysis of the empty space.
constexpr bool shows_space(InspectQuantity quantity) {
  switch (quantity) {
    case InspectQuantity::node_mapping:
    case InspectQuantity::filtered_mapping:
    case InspectQuantity::opening:
    case InspectQuantity::region_labels:
    case InspectQuantity::visibility_clusters:
    case InspectQuantity::nearest_node_visible:
      return true;
    default:
      return false;
  }
}

/// Whether the quantity belongs to a guide.
constexpr bool shows_guide(InspectQuantity quantity) {
  switch (quantity) {
    case InspectQuantity::guide_density:
    case InspectQuantity::guide_cells:
    case InspectQuantity::guide_probability:
      return true;
    default:
      return false;
  }
}

/// integrator: inspect.
struct InspectSettings {
  static constexpr std::string_view name = "inspect";
  static constexpr std::string_view doc =
      "false-colour pictures of the first hit, and of the empty space in front of it";

  InspectQuantity show = InspectQuantity::normal;
  GuideSettings guide = BsdfGuideSettings{};
  int learn = 0;
  std::array<double, 2> from{0.5, 0.5};

  static std::string_view without_lengths() { return "shows no light"; }
  static std::string_view without_letters() { return without_lengths(); }
  bool operator==(const InspectSettings&) const = default;
};

template <class V>
void describe(V& v, InspectSettings& s) {
  v("show", s.show, {.doc = "the quantity shown"});
  v("guide", s.guide, {.doc = "the guide that is shown"});
  v("learn", s.learn,
    {.doc = "training iterations, by `path` with its defaults, before the guide is shown; 0: as "
            "initialised",
     .min = 0,
     .max = 65536});
  v("from", s.from,
    {.doc =
         "the point at which the guide is evaluated: the visible surface at this fraction of the "
         "picture's width and height, from the upper left",
     .min = 0,
     .max = 1});
}

}  // namespace lacuna
