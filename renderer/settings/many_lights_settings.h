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
       "as path tracing does: a point on an emitter for each pixel, and the emitters that its ray "
       "meets"},
      {DirectLighting::lights, "lights",
       "the points on emitters where light paths start are virtual lights too"},
  }};
};

/// What bounds the geometric term, cosines over squared distance, between a surface and a light.
enum class Clamp { relative, absolute, off };

template <>
struct EnumTable<Clamp> {
  static constexpr std::array<EnumValue<Clamp>, 3> values{{
      {Clamp::relative, "relative", "`bound` / r^2, r: half the diagonal of the scene's box"},
      {Clamp::absolute, "absolute", "`bound` / (unit of the scene)^2"},
      {Clamp::off, "off", "nothing: bright spots in corners, whose variance has no bound"},
  }};
};

/// integrator: many_lights.
struct ManyLightsSettings : PathLengths {
  static constexpr std::string_view name = "many_lights";
  static constexpr std::string_view doc =
      "instant global illumination: the vertices of light paths are virtual point lights of all "
      "pixels (Noel 2015, 4.4.1)";

  static constexpr std::array layers{ImageLayer::visibility_tests, ImageLayer::negative};

  int light_paths = 1000;
  DirectLighting direct = DirectLighting::next_event;
  Clamp clamp = Clamp::relative;
  double bound = 100;
  bool compensation = true;
  double least_roughness = 0.3;
  GatherSettings gather = AllLightsSettings{};
  VisibilitySettings visibility = ExactVisibilitySettings{};

  /// The mean of many pictures is not the light in the scene.
  bool biased() const {
    const bool visibility_is = std::visit(
        []<class S>(const S& s) {
          if constexpr (requires { S::biased; }) return S::biased;
          if constexpr (requires { s.clamp_negative; }) return s.clamp_negative;
          return false;
        },
        visibility);
    const auto* random = std::get_if<RandomLightsSettings>(&gather);
    return visibility_is || !compensation || (random != nullptr && random->biased());
  }

  bool operator==(const ManyLightsSettings&) const = default;
};

template <class V>
void describe(V& v, ManyLightsSettings& s) {
  describe_lengths(v, s);
  v("light_paths", s.light_paths,
    {.doc = "light paths an iteration, shared by all pixels; each gives a light for every surface "
            "that it meets",
     .min = 1,
     .max = 1 << 20});
  v("direct", s.direct, {.doc = "light that reaches a surface straight from an emitter"});
  v("clamp", s.clamp,
    {.doc =
         "what bounds the geometric term, cosines over squared distance, between a surface and a "
         "light; lights without area are never clamped"});
  v("bound", s.bound, {.doc = "of the clamp", .min = 0, .max = 1e30, .above_min = true});
  v("compensation", s.compensation,
    {.doc = "path tracing adds what lights cannot give: what the clamp cut off, and what comes by "
            "mirrors, glass and smooth metal (Kollig and Keller 2004). Without, the picture is too "
            "dark"});
  v("least_roughness", s.least_roughness,
    {.doc = "metals smoother than this are no lights and are followed as mirrors are, and so is "
            "glass: in narrow lobes a light is a bright spot",
     .min = 0,
     .max = 1});
  v("gather", s.gather, {.doc = "which of the lights a shading point meets"});
  v("visibility", s.visibility, {.doc = "whether a surface and a light see one another"});
}

}  // namespace lacuna
