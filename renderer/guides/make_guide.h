#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "renderer/guides/mixed_guide.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {

/// The distribution of the guide with these settings; null for guide: bsdf.
std::unique_ptr<GuidingDistribution> make_guiding_distribution(const GuideSettings& settings);

/// Returns `make(guide)` with the guide of these settings: a BsdfGuide or a MixedGuide, so that
/// integrators are compiled for these two only.
template <class Make>
auto with_guide(const GuideSettings& settings, Make&& make) {
  if (auto directions = make_guiding_distribution(settings))
    return make(MixedGuide(std::move(directions)));
  return make(BsdfGuide{});
}

}  // namespace lacuna
