#pragma once

#include <string>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// Widths of a GGX distribution, alpha of Walter et al. 2007, along u and across.
struct Facets {
  std::array<double, 2> alpha{0, 0};
  std::shared_ptr<const ImportedTexture> texture;
};

/// Reads `roughness`, `uroughness`, `vroughness` (behind `prefix`) and `remaproughness`, which
/// stands for pbrt's map from a roughness in [0, 1] to alpha: sqrt(r) in pbrt-v4, a polynomial of
/// ln(r) in pbrt-v3. `otherwise` is the default. Notes textures that do not come through exactly.
Facets read_facets(Context& context, const Parameters& parameters, double otherwise,
                   const std::string& prefix = "");

/// Of a material of glTF's own.
void set_roughness(ImportedMaterial& material, const Facets& facets);

void set_facets(ImportedMaterial& material, const Facets& facets);

}  // namespace lacuna::pbrt
