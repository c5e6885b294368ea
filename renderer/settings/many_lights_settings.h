#pragma once

#include <string_view>

#include "renderer/settings/gather_settings.h"
#include "renderer/settings/output_settings.h"
#include "renderer/settings/path_lengths.h"
#include "renderer/settings/visibility_settings.h"

namespace lacuna {

/// How direct light is estimated.
enum class DirectLighting { next_event, lights };

template <>
struct EnumTable<DirectLighting> {
  static constexpr std::array<EnumValue<DirectLighting>, 2> values{{
      {DirectLighting::next_event, "next_event",
       "as in path tracing: a point on an emitter for each pixel, and the emitters that its ray "
       "hits"},
      {DirectLighting::lights, "lights",
       "the points on emitters where light paths start are virtual lights too"},
  }};
};

/// The bound of the geometric term, cosines over squared distance, between a surface and a light.
enum class Clamp { relative, absolute, off };

template <>
struct EnumTable<Clamp> {
  static constexpr std::array<EnumValue<Clamp>, 3> values{{
      {Clamp::relative, "relative", "`bound` / r^2, r: half the diagonal of the scene's box"},
      {Clamp::absolute, "absolute", "`bound` / (unit of the scene)^2"},
      {Clamp::off, "off", "no bound: bright spots in corners, with unbounded variance"},
  }};
};

/// integrator: many_lights.
struct ManyLightsSettings : PathLengths {
  static constexpr std::string_view name = "many_lights";
  static constexpr std::string_view doc =
      "instant global illumination: the vertices of light paths become virtual point lights, "
      "shared "
      "by all pixels (Noel 2015, 4.4.1)";

  static constexpr std::array layers{ImageLayer::visibility_tests, ImageLayer::negative};

  static constexpr bool shares_light_paths = true;

  int light_paths = 1000;
  DirectLighting direct = DirectLighting::next_event;
  Clamp clamp = Clamp::relative;
  double bound = 100;
  bool compensation = true;
  double least_roughness = 0.3;
  GatherSettings gather = AllLightsSettings{};
  VisibilitySettings visibility = ExactVisibilitySettings{};

  /// The expected picture differs from the radiance of the scene.
  bool biased() const {
    const bool visibility_is = std::visit(
        []<class S>(const S& s) {
          if constexpr (requires { S::biased; }) return S::biased;
          if constexpr (requires { s.clamp_negative; }) return s.clamp_negative;
          return false;
        },
        visibility);
    return visibility_is || !compensation ||
           std::visit([](const auto& g) { return g.biased(); }, gather);
  }

  std::string_view without_lengths() const {
    const auto* random = std::get_if<RandomLightsSettings>(&gather);
    if (random != nullptr && random->filter_radius > 0) {
      return "averages the virtual lights of all lengths together (\"filter_radius\")";
    }
    const auto* probabilistic = std::get_if<ProbabilisticVisibilitySettings>(&visibility);
    if (probabilistic != nullptr && probabilistic->clamp_negative) {
      return "sets a negative sum of all lengths to 0 (\"clamp_negative\")";
    }
    return {};
  }
  static std::string_view without_letters() {
    return "sums 64 virtual lights at a time, without the letters of their surfaces";
  }
  bool operator==(const ManyLightsSettings&) const = default;
};

template <class V>
void describe(V& v, ManyLightsSettings& s) {
  describe_lengths(v, s);
  v("light_paths", s.light_paths,
    {.doc =
         "light paths per iteration, shared by all pixels; every surface vertex of a path becomes "
         "a virtual light",
     .min = 1,
     .max = 1 << 20});
  v("direct", s.direct, {.doc = "how direct light is estimated"});
  v("clamp", s.clamp,
    {.doc = "bound of the geometric term, cosines over squared distance, between a surface and a "
            "virtual light; lights without area are never clamped"});
  v("bound", s.bound, {.doc = "value of the bound", .min = 0, .max = 1e30, .above_min = true});
  v("compensation", s.compensation,
    {.doc = "path tracing adds the light that virtual lights lack: the part above the bound, and "
            "light reflected or refracted by mirrors, glass and smooth metal (Kollig and Keller "
            "2004). Without it, the picture is too dark"});
  v("least_roughness", s.least_roughness,
    {.doc = "metals smoother than this, and glass, carry no virtual lights and are followed like "
            "mirrors, because a virtual light in a narrow lobe is a bright spot",
     .min = 0,
     .max = 1});
  v("gather", s.gather, {.doc = "the virtual lights gathered at a shading point"});
  v("visibility", s.visibility,
    {.doc = "how the visibility between a surface and a virtual light is estimated"});
}

}  // namespace lacuna
