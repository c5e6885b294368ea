#pragma once

#include "base/json/json_text.h"
#include "jobs/import/imported_material.h"

namespace lacuna {

/// A material in the terms of glTF and the extensions of Khronos.
struct StandardMaterial {
  ImportedValue base_color{{1, 1, 1}, nullptr};
  double metallic = 0, roughness = 1;
  double ior = 1.5, specular = 1;
  Rgb specular_color{1, 1, 1};
  double transmission = 0;
  bool solid = false;
  Rgb absorption{0, 0, 0};  ///< per scene unit, of a solid
  double coat = 0, coat_roughness = 0;
  Rgb sheen{0, 0, 0};
  double anisotropy = 0, anisotropy_rotation = 0;
  bool transmits_diffusely = false;
  ImportedValue transmitted{{0, 0, 0}, nullptr};

  /// Those that it needs, by name.
  OrderedJson extensions() const;
};

/// Whether its facets are flat everywhere.
bool is_smooth(const ImportedMaterial& material);

/// The nearest material of glTF: what other viewers show. Exact for Lambertian surfaces, diffuse
/// transmission and smooth glass.
StandardMaterial standard_material(const ImportedMaterial& material);

}  // namespace lacuna
