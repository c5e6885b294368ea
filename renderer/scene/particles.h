#pragma once

#include <array>
#include <cstdint>

#include "analysis/settings/field.h"
#include "renderer/scene/scene_data.h"

namespace lacuna {

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

/// Adds them to a scene's lights.
void add_particles(SceneData& scene, const ParticleSettings& settings);

}  // namespace lacuna
