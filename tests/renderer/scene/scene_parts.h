#pragma once

#include "renderer/geometry/scene_data.h"
#include "renderer/scene/scene.h"

namespace lacuna::test {

inline Material diffuse(const Rgb& albedo) {
  Material m;
  m.base_color = albedo;
  m.metallic = 0;
  m.specular = 0;
  return m;
}
inline Material lamp(const Rgb& radiance, bool both_sides = false) {
  Material m = diffuse(Rgb(0, 0, 0));
  m.emission = radiance;
  m.double_sided = both_sides;
  return m;
}
/// Roughness is glTF's: the square root of GGX's alpha. 0: a mirror.
inline Material metal(const Rgb& colour, float roughness) {
  Material m;
  m.base_color = colour;
  m.roughness = roughness;
  return m;
}
/// A solid.
inline Material glass(float roughness = 0) {
  Material m;
  m.metallic = 0;
  m.roughness = roughness;
  m.transmission = 1;
  m.extensions.volume.solid = true;
  return m;
}
/// A thin wall.
inline Material window(float roughness = 0) {
  Material m = glass(roughness);
  m.extensions.volume.solid = false;
  return m;
}
/// Diffuse under a coat; smooth: a delta lobe and another one.
inline Material plastic(const Rgb& colour, float roughness = 0) {
  Material m;
  m.base_color = colour;
  m.metallic = 0;
  m.roughness = roughness;
  return m;
}

/// A scene that is put together in memory.
struct SceneParts {
  SceneData data;

  std::uint32_t material(const Material& m) {
    data.materials.push_back(m);
    return static_cast<std::uint32_t>(data.materials.size() - 1);
  }
  /// Returns the mesh; its uvs run from o along a and b, and its front side is a x b.
  std::uint32_t quad(const V3f& o, const V3f& a, const V3f& b, std::uint32_t material) {
    Mesh mesh;
    mesh.positions = {o, o + a, o + a + b, o + b};
    mesh.uvs[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.material = material;
    data.meshes.push_back(std::move(mesh));
    return static_cast<std::uint32_t>(data.meshes.size() - 1);
  }
  /// The six sides of a box, seen from outside or from inside.
  void box(const V3f& low, const V3f& high, bool from_outside, std::uint32_t material) {
    for (int k = 0; k < 3; ++k) {
      V3f a(0), b(0);
      a[(k + 1) % 3] = (high - low)[(k + 1) % 3];
      b[(k + 2) % 3] = (high - low)[(k + 2) % 3];
      for (const bool upper : {false, true}) {
        V3f o = low;
        if (upper) o[k] = high[k];
        const bool along = upper == from_outside;  // a x b points up the axis
        quad(o, along ? a : b, along ? b : a, material);
      }
    }
  }
  void light(PunctualLight::Kind kind, const V3f& position, const V3f& direction,
             const Rgb& intensity) {
    PunctualLight l;
    l.kind = kind;
    l.position = position;
    l.direction = direction.normalized();
    l.intensity = intensity;
    data.lights.push_back(l);
  }
  /// A camera at `from` that looks towards `to`, which is not straight above or below.
  void eye(const V3d& from, const V3d& to, double yfov) {
    const V3d back = (from - to).normalized();
    const V3d right = V3d(0, 1, 0).cross(back).normalized();
    const V3d up = back.cross(right);
    CameraData camera;
    camera.name = "eye";
    camera.yfov = yfov;
    const std::array<V3d, 4> rows{right, up, back, from};
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) camera.to_world[i][k] = rows[static_cast<std::size_t>(i)][k];
    }
    data.cameras.push_back(camera);
  }
};

/// Ready for paths of light.
inline Scene lit_scene(SceneData data,
                       const std::optional<EnvironmentImage>& environment = std::nullopt) {
  const ThreadPool pool(1);
  return {std::move(data),
          {.materials = true, .emission = true, .light_tree = true},
          environment,
          pool};
}

}  // namespace lacuna::test
