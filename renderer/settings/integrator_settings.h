#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "renderer/settings/bdpt_settings.h"
#include "renderer/settings/bias.h"
#include "renderer/settings/inspect_settings.h"
#include "renderer/settings/light_settings.h"
#include "renderer/settings/many_lights_settings.h"
#include "renderer/settings/metropolis_settings.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/path_settings.h"
#include "renderer/settings/photon_mapping_settings.h"
#include "renderer/settings/vcm_settings.h"

namespace lacuna {

/// The integrator and its settings. The order is that of menus; the first is the default.
/// renderer/integrators/registry.cpp constructs the integrator of each alternative.
using IntegratorSettings =
    std::variant<PathSettings, LightSettings, BdptSettings, VcmSettings, SppmSettings,
                 PhotonMapSettings, ManyLightsSettings, MetropolisSettings, InspectSettings>;

/// The layers that the integrator of these settings fills itself. Its settings struct lists them,
/// if there are any, as
///
///     static constexpr std::array layers{ImageLayer::strategies};
template <class... Ts>
std::span<const ImageLayer> filled_layers(const std::variant<Ts...>& settings) {
  return std::visit(
      []<class S>(const S&) -> std::span<const ImageLayer> {
        if constexpr (requires { S::layers; }) {
          return S::layers;
        } else {
          return {};
        }
      },
      settings);
}

/// Whether a job's `sampler` stratifies the samples of these settings: true unless they have a
/// `static constexpr bool spreads_samples = false`.
template <class... Ts>
bool spreads_samples(const std::variant<Ts...>& settings) {
  return std::visit(
      []<class S>(const S&) {
        if constexpr (requires { S::spreads_samples; }) return S::spreads_samples;
        return true;
      },
      settings);
}

/// Whether paths start only at lights and are connected to the eye: true if the settings have a
/// `static constexpr bool from_lights_only = true`.
template <class... Ts>
bool from_lights_only(const std::variant<Ts...>& settings) {
  return std::visit(
      []<class S>(const S&) {
        if constexpr (requires { S::from_lights_only; }) return S::from_lights_only;
        return false;
      },
      settings);
}

/// The light paths of an iteration, for methods whose pixels share them and miss the light that
/// they do not carry: settings with a `static constexpr bool shares_light_paths = true`. None for
/// other methods. `pixels`: of the picture, the number if `light_paths` is 0.
template <class... Ts>
std::optional<double> shared_light_paths(const std::variant<Ts...>& settings, double pixels) {
  return std::visit(
      [&]<class S>(const S& s) -> std::optional<double> {
        if constexpr (requires { S::shares_light_paths; }) {
          return s.light_paths > 0 ? double(s.light_paths) : pixels;
        } else {
          return std::nullopt;
        }
      },
      settings);
}

/// Why the integrator's settings are incompatible, as the continuation of "found ..."; empty if
/// they are compatible. An alternative may define such a function.
template <class... Ts>
std::string_view conflict(const std::variant<Ts...>& settings) {
  return std::visit(
      [](const auto& s) -> std::string_view {
        if constexpr (requires { s.conflict(); }) return s.conflict();
        return {};
      },
      settings);
}

/// The longest paths, in edges; 0 if there are none.
template <class... Ts>
int most_edges(const std::variant<Ts...>& settings) {
  return std::visit(
      []<class S>(const S& s) {
        if constexpr (requires { s.max_depth; }) return s.max_depth;
        return 0;
      },
      settings);
}

/// Why the integrator cannot tell the lengths of its paths apart, or their letters, as the
/// continuation of "found ... in a job of integrator ..., which "; empty if it can. An alternative
/// may define such functions.
template <class... Ts>
std::string_view without_lengths(const std::variant<Ts...>& settings) {
  return std::visit(
      []<class S>(const S& s) -> std::string_view {
        if constexpr (requires { s.without_lengths(); }) return s.without_lengths();
        return {};
      },
      settings);
}
template <class... Ts>
std::string_view without_letters(const std::variant<Ts...>& settings) {
  return std::visit(
      []<class S>(const S& s) -> std::string_view {
        if constexpr (requires { s.without_letters(); }) return s.without_letters();
        return {};
      },
      settings);
}

/// All layers that a job with this integrator may request.
template <class... Ts>
std::vector<ImageLayer> offered_layers(const std::variant<Ts...>& settings) {
  std::vector<ImageLayer> all(common_layers.begin(), common_layers.end());
  if (without_lengths(settings).empty()) all.push_back(ImageLayer::lengths);
  const auto own = filled_layers(settings);
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

}  // namespace lacuna
