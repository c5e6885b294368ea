#pragma once

#include <functional>
#include <string>

#include "jobs/import/pbrt/pbrt_context.h"
#include "jobs/import/pbrt/pbrt_shapes.h"

namespace lacuna::pbrt {

/// Reads a `LightSource` into the scene, in pbrt's coordinates. Light from infinitely far that the
/// scene has already is joined if both are uniform, else left out with a note. Throws SceneError
/// for unknown types.
void read_light(Context& context, ImportedScene& scene, const std::string& type,
                const Parameters& parameters, const M44d& to_world);

/// What an `AreaLightSource "diffuse"` makes of a shape.
struct AreaLight {
  ImportedValue radiance;
  bool two_sided = false;
};
/// `find_areas` is called for a light of a power.
AreaLight area_light(Context& context, const Parameters& parameters,
                     const std::function<Areas()>& find_areas, bool of_triangles);

}  // namespace lacuna::pbrt
