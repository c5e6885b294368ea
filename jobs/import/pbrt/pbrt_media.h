#pragma once

#include <string>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// What is known of a named medium.
struct Medium {
  Rgb absorption{0, 0, 0};  ///< per scene unit
  bool scatters = false;
  bool uniform = false;  ///< homogeneous, of coefficients that the file states
  Place place;
  std::string name;
};

/// A MakeNamedMedium statement. pbrt's coefficients where the file states none.
Medium read_medium(Context& context, const std::string& name, const Parameters& parameters);

/// A material whose inside is `medium`: absorption within a dielectric, else the material itself.
/// Notes what is left out, for the shape at `place`.
ImportedMaterial filled_with(Context& context, const ImportedMaterial& material,
                             const Medium& medium, const Place& place);

}  // namespace lacuna::pbrt
