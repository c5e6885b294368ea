#pragma once

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/integrators/render.h"

namespace lacuna::test {

/// The scene under x -> scale x + offset. Radiances stay; a point's W/sr goes with the square of
/// lengths.
inline SceneData transformed(const char* name, double scale, const V3d& offset) {
  SceneData scene = load_gltf(own_scene(name));
  for (Mesh& mesh : scene.meshes) {
    for (V3f& p : mesh.positions) p = V3f(V3d(p) * scale + offset);
  }
  for (CameraData& c : scene.cameras) {
    for (int k = 0; k < 3; ++k) c.to_world[3][k] = c.to_world[3][k] * scale + offset[k];
  }
  for (PunctualLight& l : scene.lights) {
    l.position = V3f(V3d(l.position) * scale + offset);
    if (l.kind != PunctualLight::Kind::directional)
      l.intensity *= static_cast<float>(scale * scale);
  }
  return scene;
}

}  // namespace lacuna::test
