#pragma once

#include <ostream>
#include <string>

#include "renderer/gltf/gltf_load.h"
#include "renderer/scene/particles.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna::test {

/// A scene on which paths of all kinds are made, with its first camera.
struct PathScene {
  std::string name;
  bool sky = false;  ///< lit by sky.hdr too
  friend std::ostream& operator<<(std::ostream& out, const PathScene& s) { return out << s.name; }
};

inline std::filesystem::path scene_path(const std::string& name) {
  return std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / name;
}

/// A box of smooth plastic, whose every vertex scatters through a delta lobe and another, with a
/// rough metal and a glass block in it, and emitters that shine from one side and from both; with
/// `points`, from a point and a cone too, whose reflections in the plastic no path from the eye can
/// find.
inline SceneData coated_box(bool points) {
  SceneParts p;
  const auto wall = p.material(plastic(Rgb(0.7F, 0.6F, 0.5F)));
  p.box({0, 0, 0}, {3, 2, 4}, false, wall);
  p.box({0.5F, 0, 1}, {1, 0.8F, 1.6F}, true, p.material(metal(Rgb(0.9F), 0.4F)));
  p.box({1.8F, 0, 1.2F}, {2.4F, 0.7F, 1.7F}, true, p.material(glass(0.3F)));
  p.quad({1, 1.9F, 1}, {1, 0, 0}, {0, 0, 1}, p.material(lamp(Rgb(3, 4, 5))));
  p.quad({0.2F, 0.3F, 2}, {0, 0.5F, 0}, {0, 0, 0.5F}, p.material(lamp(Rgb(5, 2, 1), true)));
  if (points) {
    p.light(PunctualLight::Kind::point, {2.5F, 1.5F, 3}, {0, 0, -1}, Rgb(1, 1, 1));
    p.light(PunctualLight::Kind::spot, {0.5F, 1.5F, 3}, {0.5F, -1, -0.5F}, Rgb(4, 4, 4));
  }
  p.eye({1.5, 1, 3.8}, {1.4, 0.8, 0}, 1.2);
  return std::move(p.data);
}

/// A room whose walls' shading normals all lean to one side, lit through a slab of rough glass:
/// where light and eye scatter most differently (Veach 1997, ch. 5).
inline SceneData leaning_room() {
  SceneParts p;
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(diffuse(Rgb(0.7F, 0.6F, 0.5F))));
  p.quad({-0.7F, -1, -0.9F}, {0, 0, 1.2F}, {0.5F, 0.9F, 0}, p.material(metal(Rgb(0.9F), 0.6F)));
  for (Mesh& mesh : p.data.meshes) {
    const V3f ng = TriangleShape(mesh, 0).ng;
    mesh.normals.assign(4, (ng + V3f(0.5F, -0.3F, 0.6F)).normalized());
  }
  p.box({-0.6F, 0.5F, -0.6F}, {0.6F, 0.7F, 0.6F}, true, p.material(glass(0.5F)));
  p.quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, p.material(lamp(Rgb(6, 7, 8))));
  p.eye({0.3, -0.1, 0.9}, {-0.1, -0.2, -1}, 1.5);
  return std::move(p.data);
}

/// Two rooms with a lamp in each, one ten times as bright; the eye stands in the only gap between
/// them and sees both. Few paths of light pass from one to the other.
inline SceneData two_rooms() {
  SceneParts p;
  const auto wall = p.material(diffuse(Rgb(0.7F, 0.6F, 0.5F)));
  p.box({-2, -1, -1}, {2, 1, 1}, false, wall);
  p.box({-0.05F, -1, -1}, {0.05F, 1, 0.8F}, true, wall);
  p.quad({-1.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, p.material(lamp(Rgb(20, 20, 20))));
  p.quad({0.6F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, p.material(lamp(Rgb(2, 2, 2))));
  p.eye({0, 0, 0.95}, {0, -0.2, -1}, 1.5);
  return std::move(p.data);
}

/// A block of clear glass and a box above a floor in the sun, which shines through the glass: paths
/// of light find its caustics, paths of the eye do not.
inline SceneData sunlit_glass() {
  SceneParts p;
  const auto grey = p.material(diffuse(Rgb(0.7F, 0.6F, 0.5F)));
  p.quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, grey);
  p.box({-0.6F, 0.4F, -0.6F}, {0.4F, 1, 0.6F}, true, p.material(glass()));
  p.box({0.7F, 0, -0.5F}, {1.2F, 0.9F, 0.5F}, true, grey);
  p.light(PunctualLight::Kind::directional, {0, 0, 0}, {0.4F, -1, -0.2F}, Rgb(3, 2.5F, 2));
  p.eye({0.3, 1.6, 2.6}, {0.1, 0.3, 0}, 0.9);
  return std::move(p.data);
}

/// A nearly black room: what a light path carries falls by eight decades at each surface.
inline SceneData black_room() {
  SceneParts p;
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(diffuse(Rgb(1e-8F))));
  p.quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, p.material(lamp(Rgb(6, 7, 8))));
  p.eye({0.3, -0.1, 0.9}, {-0.1, -0.2, -1}, 1.5);
  return std::move(p.data);
}

inline SceneData load(const PathScene& s) {
  if (s.name == "black") return black_room();
  if (s.name == "two_rooms") return two_rooms();
  if (s.name == "leaning") return leaning_room();
  if (s.name == "particles") {
    SceneData data = load_gltf(scene_path("cornell.glb"));
    for (Material& m : data.materials) m.emission = Rgb(0, 0, 0);
    add_particles(data, {.count = 777, .power = 50, .alone = true});
    return data;
  }
  if (s.name == "sunlit_glass") return sunlit_glass();
  if (s.name == "coated") return coated_box(false);
  if (s.name == "coated_points") return coated_box(true);
  return load_gltf(scene_path(s.name + ".glb"));
}
inline std::optional<EnvironmentImage> environment(const PathScene& s) {
  return s.sky ? std::optional(EnvironmentImage{scene_path("sky.hdr"), 1, 0.7F}) : std::nullopt;
}

inline std::vector<PathScene> path_scenes() {
  return {{"cornell"}, {"glass"},  {"mirror"}, {"furnace_sphere"}, {"many_lights"},
          {"point"},   {"spot"},   {"sides"},  {"directional"},    {"open", true},
          {"ajar"},    {"coated"}, {"atrium"}, {"leaning"}};
}

}  // namespace lacuna::test
