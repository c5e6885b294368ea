#pragma once

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

/// Where the next ray of a path from the eye goes. A new guide is one more alternative here.
using GuideSettings = std::variant<BsdfGuideSettings>;

}  // namespace lacuna
