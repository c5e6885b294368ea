#pragma once

#include <string_view>

#include "renderer/settings/light_guide_settings.h"
#include "renderer/settings/path_lengths.h"
#include "renderer/settings/photon_settings.h"

namespace lacuna {

/// What photon mapping and its progressive form have in common.
struct PhotonTracing : PathLengths, RadiusSettings {
  static constexpr bool shares_light_paths = true;

  int light_paths = 0;
  bool next_event_estimation = true;
  PhotonKernel kernel = PhotonKernel::constant;
  double least_roughness = 0.3;
  LightGuideSettings light_guide = BsdfGuideSettings{};
  bool operator==(const PhotonTracing&) const = default;
};

template <class V>
void describe_photons(V& v, PhotonTracing& s) {
  describe_lengths(v, s);
  v("light_paths", s.light_paths,
    {.doc =
         "light paths per iteration, shared by all pixels; every surface vertex of a path leaves "
         "a photon. 0: one path for each pixel",
     .min = 0,
     .max = 1 << 22});
  describe_radius(v, s);
  v("kernel", s.kernel, {.doc = "how a photon counts by its distance"});
  v("next_event_estimation", s.next_event_estimation,
    {.doc = "estimate direct light as in path tracing, by points on emitters and the emitters that "
            "eye paths hit; without it, photons bring direct light, too"});
  v("least_roughness", s.least_roughness,
    {.doc = "metals smoother than this, and glass, are followed like mirrors: few photons arrive "
            "in a narrow lobe",
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

  /// By the radius of each iteration; see RadiusSettings::consistent().
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
      "Noel 2015, 4.5). The radius stays, and with it a bias at which the error levels off";

  int nearest = 0;
  bool final_gather = false;
  int caustic_paths = 0;

  PhotonMapSettings() {
    radius = 8;
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
    {.doc = "estimate the density from this number of nearest photons, where so many lie within "
            "`radius`; 0: from all within `radius`",
     .min = 0,
     .max = 1024});
  v("final_gather", s.final_gather,
    {.doc = "at the first surface, look up caustics only, and gather other indirect light by one "
            "more edge to where photons are looked up: less bias, more noise"});
  v("caustic_paths", s.caustic_paths,
    {.doc = "light paths per iteration whose caustics, light by way of mirrors or glass only, have "
            "a map of their own; 0: the photons of all paths are in one map",
     .min = 0,
     .max = 1 << 22});
}

}  // namespace lacuna
