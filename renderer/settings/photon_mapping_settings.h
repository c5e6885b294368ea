#pragma once

#include <string_view>

#include "renderer/settings/light_guide_settings.h"
#include "renderer/settings/path_lengths.h"
#include "renderer/settings/photon_settings.h"

namespace lacuna {

/// Settings common to photon mapping and its progressive form.
struct PhotonTracing : PathLengths, RadiusSettings {
  static constexpr bool shares_light_paths = true;

  int light_paths = 0;
  bool next_event_estimation = true;
  PhotonKernel kernel = PhotonKernel::constant;
  double least_roughness = 0.3;
  LightGuideSettings light_guide = BsdfGuideSettings{};

  PhotonTracing() { radius = 8; }  // docs/notebook/photons.md
  bool operator==(const PhotonTracing&) const = default;
};

template <class V>
void describe_photons(V& v, PhotonTracing& s) {
  describe_lengths(v, s);
  v("light_paths", s.light_paths,
    {.doc = "light paths per iteration, shared by all pixels; every surface vertex of a path "
            "stores a photon. 0: one path per pixel",
     .min = 0,
     .max = 1 << 22});
  describe_radius(v, s);
  v("kernel", s.kernel, {.doc = "how the weight of a photon depends on its distance"});
  v("next_event_estimation", s.next_event_estimation,
    {.doc = "estimate direct light as in path tracing, by points on emitters and the emitters that "
            "eye paths hit; otherwise photons carry direct light, too"});
  v("least_roughness", s.least_roughness,
    {.doc = "metals smoother than this, and glass, are followed like mirrors: few photons arrive "
            "within a narrow lobe",
     .min = 0,
     .max = 1});
  describe_light_guide(v, s.light_guide);
}

/// integrator: sppm.
struct SppmSettings : PhotonTracing {
  static constexpr std::string_view name = "sppm";
  static constexpr std::string_view doc =
      "stochastic progressive photon mapping: photons and eye paths of each iteration are new, and "
      "the radius shrinks (Hachisuka and Jensen 2009; Noel 2015, 4.5.2)";

  /// True for the radius of each iteration; see RadiusSettings::consistent().
  static constexpr bool biased() { return true; }
  bool operator==(const SppmSettings&) const = default;
};

template <class V>
void describe(V& v, SppmSettings& s) {
  describe_photons(v, s);
  describe_alpha(v, s);
}

/// integrator: photon_map.
struct PhotonMapSettings : PhotonTracing {
  static constexpr std::string_view name = "photon_map";
  static constexpr std::string_view doc =
      "photon mapping: the density of the photons around a point is the light there (Jensen 1996; "
      "Noel 2015, 4.5). The radius is fixed, and with it a bias below which the error does not "
      "fall";

  int nearest = 0;
  bool final_gather = false;
  int caustic_paths = 0;

  PhotonMapSettings() {
    alpha = 1;
    kernel = PhotonKernel::cone;
  }
  static constexpr bool biased() { return true; }
  bool operator==(const PhotonMapSettings&) const = default;
};

template <class V>
void describe(V& v, PhotonMapSettings& s) {
  describe_photons(v, s);
  v("nearest", s.nearest,
    {.doc = "estimate the density from this number of nearest photons, if `radius` contains that "
            "many; 0: from all photons within `radius`",
     .min = 0,
     .max = 1024});
  v("final_gather", s.final_gather,
    {.doc = "look up only caustics at the first surface, and gather other indirect light by one "
            "further edge, at whose end photons are looked up: less bias, more noise"});
  v("caustic_paths", s.caustic_paths,
    {.doc = "light paths per iteration for a separate map of caustics, light that arrives by "
            "mirrors or glass only; 0: one map of all photons",
     .min = 0,
     .max = 1 << 22});
}

}  // namespace lacuna
