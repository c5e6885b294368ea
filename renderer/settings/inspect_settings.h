#pragma once

#include <array>
#include <string_view>

#include "analysis/settings/field.h"

namespace lacuna {

/// What integrator `inspect` shows.
enum class InspectQuantity { normal, albedo, depth, emission };

template <>
struct EnumTable<InspectQuantity> {
  static constexpr std::array<EnumValue<InspectQuantity>, 4> values{{
      {InspectQuantity::normal, "normal", "shading normal, world space, components in [-1, 1]"},
      {InspectQuantity::albedo, "albedo", "base reflectance"},
      {InspectQuantity::depth, "depth", "distance from the eye, scene units"},
      {InspectQuantity::emission, "emission", "radiance emitted towards the eye"},
  }};
};

/// integrator: inspect.
struct InspectSettings {
  static constexpr std::string_view name = "inspect";
  static constexpr std::string_view doc = "false-colour pictures of what the first hit is";

  InspectQuantity show = InspectQuantity::normal;

  bool operator==(const InspectSettings&) const = default;
};

template <class V>
void describe(V& v, InspectSettings& s) {
  v("show", s.show, {.doc = "the quantity"});
}

}  // namespace lacuna
