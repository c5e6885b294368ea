#pragma once

#include <array>
#include <string>

#include "analysis/settings/field.h"

namespace lacuna {

/// One of a scene's materials as another would have it: how a method fares with a glossy floor.
struct MaterialChange {
  std::string name;
  double roughness = 1;
  double metallic = 0;
  bool operator==(const MaterialChange&) const = default;
};
template <class V>
void describe(V& v, MaterialChange& s) {
  v("name", s.name,
    {.doc = "of the materials of that name in the file", .min = 1, .max = 1024, .required = true});
  v("roughness", s.roughness,
    {.doc = "as in glTF: GGX's alpha is its square; a texture of it is left out",
     .min = 0,
     .max = 1,
     .required = true});
  v("metallic", s.metallic, {.doc = "as in glTF: 0 a dielectric, 1 a metal", .min = 0, .max = 1});
}

/// Glowing particles (Kol et al. 2018, 5.2): point lights at random places.
struct ParticleSettings {
  int count = 0;
  double power = 0;
  std::array<double, 3> color{1, 1, 1};
  std::array<double, 3> low{0, 0, 0};
  std::array<double, 3> high{1, 1, 1};
  int seed = 1;
  bool alone = false;
  bool operator==(const ParticleSettings&) const = default;
};
template <class V>
void describe(V& v, ParticleSettings& s) {
  v("count", s.count,
    {.doc = "point lights that shine alike in all directions",
     .min = 1,
     .max = 1 << 20,
     .required = true});
  v("power", s.power,
    {.doc = "of all together", .min = 0, .max = 1e12, .required = true, .unit = "W"});
  v("color", s.color, {.doc = "multiplies the power: red, green, blue", .min = 0, .max = 1});
  v("low", s.low,
    {.doc =
         "they lie evenly between the lowest and the highest corner of the scene's box: from this "
         "share of the way, along x, y and z,",
     .min = 0,
     .max = 1});
  v("high", s.high, {.doc = "to this", .min = 0, .max = 1});
  v("seed", s.seed, {.doc = "of their places", .min = 0, .max = 2147483647});
  v("alone", s.alone,
    {.doc = "the scene's own point, spot and directional lights are left out; surfaces that glow "
            "are not"});
}

}  // namespace lacuna
