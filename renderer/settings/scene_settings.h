#pragma once

#include <array>
#include <string>

#include "base/settings/field.h"

namespace lacuna {

/// What the numbers of a file's punctual lights are.
enum class LightUnits { file, radiometric, photometric };
template <>
struct EnumTable<LightUnits> {
  static constexpr std::array<EnumValue<LightUnits>, 3> values{{
      {LightUnits::file, "file",
       "read 1:1 as W/sr and W/m^2, with a warning where the file's exporter multiplies watts by "
       "683 lm/W"},
      {LightUnits::radiometric, "radiometric", "W/sr and W/m^2: read 1:1"},
      {LightUnits::photometric, "photometric", "cd and lx of 683 lm/W: divided by 683"},
  }};
};

/// A change of one of the scene's materials, to test a method with, for example, a glossy floor.
struct MaterialChange {
  std::string name;
  double roughness = 1;
  double metallic = 0;
  bool operator==(const MaterialChange&) const = default;
};
template <class V>
void describe(V& v, MaterialChange& s) {
  v("name", s.name,
    {.doc = "name of the materials in the file that are changed",
     .min = 1,
     .max = 1024,
     .required = true});
  v("roughness", s.roughness,
    {.doc = "as in glTF: GGX's alpha is its square; a roughness texture is ignored",
     .min = 0,
     .max = 1,
     .required = true});
  v("metallic", s.metallic,
    {.doc = "as in glTF: 0 is a dielectric, 1 a metal", .min = 0, .max = 1});
}

/// Glowing particles (Kol et al. 2018, 5.2): point lights at random positions.
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
    {.doc = "number of isotropic point lights", .min = 1, .max = 1 << 20, .required = true});
  v("power", s.power,
    {.doc = "total power of all particles", .min = 0, .max = 1e12, .required = true, .unit = "W"});
  v("color", s.color, {.doc = "multiplies the power: red, green, blue", .min = 0, .max = 1});
  v("low", s.low,
    {.doc =
         "lower corner of the box in which particles are uniformly distributed, along x, y and z: "
         "0 is the lower and 1 the upper corner of the scene's bounding box",
     .min = 0,
     .max = 1});
  v("high", s.high, {.doc = "upper corner of that box, along x, y and z", .min = 0, .max = 1});
  v("seed", s.seed, {.doc = "seed of the random positions", .min = 0, .max = 2147483647});
  v("alone", s.alone,
    {.doc = "remove the scene's point, spot and directional lights; emissive surfaces remain"});
}

}  // namespace lacuna
