#pragma once

#include <string>

#include "jobs/import/pbrt/pbrt_context.h"

namespace lacuna::pbrt {

/// A material by pbrt's name of its type, with its bump and normal maps. Sets `invisible` for
/// pbrt-v4's `interface` and pbrt-v3's `none`. Throws SceneError for unknown types.
ImportedMaterial make_material(Context& context, const std::string& type,
                               const Parameters& parameters, bool& invisible);

/// What the parts of make_material() share. Each returns none for a type that is not of its kind.
std::optional<ImportedMaterial> make_v4_material(Context& context, const std::string& type,
                                                 const Parameters& parameters);
std::optional<ImportedMaterial> make_v3_material(Context& context, const std::string& type,
                                                 const Parameters& parameters);

/// A named material, which may still be undefined.
std::shared_ptr<MaterialEntry> named_material(Context& context, const std::string& name,
                                              const Place& place);

/// All of the light is reflected: Fresnel's equations at an index of i.
ImportedMaterial perfect_mirror(const ImportedValue& reflectance);

/// A Lambertian lobe on this side and one on the other. Exact if the two together are at most 1.
ImportedMaterial diffuse_both_sides(Context& context, const Parameters& parameters,
                                    const ImportedValue& reflected,
                                    const ImportedValue& transmitted);

/// A mixture of two parts, with a weight for each.
ImportedMaterial mixture_of(const ImportedMaterial& first, const Rgb& weight,
                            const ImportedMaterial& second, const Rgb& second_weight);

}  // namespace lacuna::pbrt
