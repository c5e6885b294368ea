#include "renderer/gltf/gltf_cameras.h"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "renderer/gltf/gltf_limits.h"

namespace lacuna::gltf {
namespace {

V3d axis(const M44d& m, int i) { return {m[i][0], m[i][1], m[i][2]}; }

/// The same view without scale or shear; a mirrored one stays mirrored.
M44d orthonormal(const PlacedNode& node, const V3d& origin) {
  const M44d& m = node.turn;
  const V3d z = axis(m, 2).normalized();
  const V3d x = (axis(m, 0) - z * z.dot(axis(m, 0))).normalized();
  const V3d y = z.cross(x) * (node.mirrored ? -1.0 : 1.0);
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

/// In scene coordinates.
V3d position_of(const PlacedNode& node, const V3d& scene_origin) {
  const V3d origin = axis(node.to_world, 3);
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(origin[i]) <= max_coordinate))
      node.place.fail("its position is " + number_text(origin[i]) +
                      "; allowed: " + coordinate_rule);
  }
  return origin - scene_origin;
}

void read_perspective(const GltfObject& camera, CameraData& out) {
  const auto lens = camera.object("perspective");
  if (!lens) camera.fail("perspective is missing");
  out.yfov = lens->number("yfov", Limits{0, std::numbers::pi});
  if (out.yfov == 0 || out.yfov == std::numbers::pi) {
    lens->refuse("yfov", "radians above 0 and below pi");
  }
}

/// The height of the picture is that of the file; its width follows from the film, as in a
/// perspective camera. Negative magnifications turn the picture over in some viewers; here they
/// count like positive ones.
void read_orthographic(const GltfObject& camera, CameraData& out) {
  const auto film = camera.object("orthographic");
  if (!film) camera.fail("orthographic is missing");
  out.projection = Projection::orthographic;
  film->number("xmag", any_float);
  out.height = 2 * std::abs(film->number("ymag", any_float));
  if (out.height == 0) film->refuse("ymag", "any number but 0");
}

CameraData read_camera(const GltfObject& camera, const PlacedNode& node, const V3d& origin) {
  CameraData out;
  out.node = node.place.string("name", "");
  out.name = camera.string("name", out.node);
  if (camera.string("type") == "orthographic") {
    read_orthographic(camera, out);
  } else {
    read_perspective(camera, out);
  }
  out.to_world = orthonormal(node, position_of(node, origin));
  return out;
}

/// Reads the cones of a spot. KHR_lights_punctual wants the inner one within the outer one; where
/// both are one, as Blender writes a spot without blend, the edge is hard.
void read_cones(const GltfObject& light, PunctualLight& out, Warnings& warnings) {
  const auto spot = light.object("spot");
  if (!spot) light.fail("spot is missing");
  const Limits angle{0, std::numbers::pi_v<float> / 2};  // what pi/2 is when written as a float
  double inner = spot->number("innerConeAngle", 0, angle);
  const double outer = spot->number("outerConeAngle", std::numbers::pi / 4, angle);
  if (outer == 0) spot->refuse("outerConeAngle", "radians above 0 and up to pi / 2");
  if (inner > outer) {
    const std::string both =
        "innerConeAngle " + number_text(inner) + " is above outerConeAngle " + number_text(outer);
    constexpr double few_digits = 1e-4;  // angles that were written with few digits
    if (inner > outer * (1 + few_digits)) spot->fail(both);
    warnings.once(spot->label() + ": " + both + "; it is read as the same: a hard edge");
    inner = outer;
  }
  // The directions that reach a point from a light are rounded to floats: by 2^-24 in each axis.
  constexpr double narrowest = 0x1p-20;
  if (outer < narrowest) {
    warnings.once(spot->label() + ": outerConeAngle " + number_text(outer) + " is below " +
                  number_text(narrowest) +
                  " rad, which directions in single precision do not resolve: the edge of its "
                  "light is uncertain");
  }
  out.inner_cone = static_cast<float>(inner);
  out.outer_cone = static_cast<float>(outer);
}

PunctualLight read_light(const GltfObject& light, const PlacedNode& node, const V3d& origin,
                         Warnings& warnings) {
  PunctualLight out;
  out.name = light.string("name", node.place.string("name", ""));
  const auto color = light.light_colour("color").value_or(std::array{1.0, 1.0, 1.0});
  const double intensity = light.number("intensity", 1, non_negative);
  out.intensity =
      Rgb(static_cast<float>(color[0] * intensity), static_cast<float>(color[1] * intensity),
          static_cast<float>(color[2] * intensity));
  if (!is_finite(out.intensity)) {
    light.fail("color times intensity is more than a float can hold");
  }
  const std::string type = light.string("type");
  if (type == "point") {
    out.kind = PunctualLight::Kind::point;
  } else if (type == "directional") {
    out.kind = PunctualLight::Kind::directional;
  } else if (type == "spot") {
    out.kind = PunctualLight::Kind::spot;
    read_cones(light, out, warnings);
  } else {
    light.refuse("type", "\"point\", \"spot\" or \"directional\"");
  }
  if (light.has("range"))
    warnings.once(
        "the range of punctual lights is left out: light falls off with the square of distance");
  out.position = V3f(position_of(node, origin));
  out.direction = V3f(-axis(node.turn, 2).normalized());
  return out;
}

/// Whether "4.5.32" is at least major.minor.
bool is_version_from(const std::string& version, int major, int minor) {
  int found_major = 0, found_minor = 0;
  if (std::sscanf(version.c_str(), "%d.%d", &found_major, &found_minor) < 1) return false;
  return found_major > major || (found_major == major && found_minor >= minor);
}

void warn_of_no_direction(const PlacedNode& node, const std::string& thing) {
  node.place.warn("direction", "its matrix is singular and gives its " + thing +
                                   " no direction; the " + thing + " is left out");
}

/// Where the last camera has the name of another, as cameras that several nodes share, it is called
/// like its node.
void name_apart(std::vector<CameraData>& cameras, const GltfObject& node) {
  CameraData& last = cameras.back();
  const auto taken = [&] {
    return std::any_of(cameras.begin(), cameras.end() - 1,
                       [&](const CameraData& other) { return other.name == last.name; });
  };
  if (!taken()) return;
  const std::string shared = last.name;
  last.name = last.node;
  if (taken() || last.name.empty()) last.name = node.label().substr(0, node.label().find(' '));
  if (shared.empty()) return;
  node.warn("shared camera", "another camera is called " + in_quotes(shared) +
                                 ", too; this one is called " + in_quotes(last.name));
}

}  // namespace

std::vector<CameraData> read_cameras(const GltfObject& root, const std::vector<PlacedNode>& nodes,
                                     const V3d& origin) {
  std::vector<CameraData> out;
  const auto cameras = root.objects("cameras");
  for (const PlacedNode& node : nodes) {
    const auto index = node.place.index("camera", cameras.size(), "cameras");
    if (!index) continue;
    const GltfObject& camera = cameras[*index];
    const std::string type = camera.string("type");
    if (type != "perspective" && type != "orthographic") {
      camera.refuse("type", "\"perspective\" or \"orthographic\"");
    }
    if (!node.can_turn) {
      warn_of_no_direction(node, "camera");
    } else {
      out.push_back(read_camera(camera, node, origin));
      name_apart(out, node.place);
    }
  }
  return out;
}

std::vector<PunctualLight> read_lights(const GltfObject& root, const std::vector<PlacedNode>& nodes,
                                       const V3d& origin, Warnings& warnings) {
  std::vector<PunctualLight> out;
  const auto extension = root.extension("KHR_lights_punctual");
  const auto lights = extension ? extension->objects("lights") : std::vector<GltfObject>{};
  for (const PlacedNode& node : nodes) {
    const auto reference = node.place.extension("KHR_lights_punctual");
    if (!reference || !node.visible) continue;
    const auto index =
        reference->index("light", lights.size(), "extensions.KHR_lights_punctual.lights");
    if (!index) continue;
    const PunctualLight light = read_light(lights[*index], node, origin, warnings);
    if (light.kind != PunctualLight::Kind::point && !node.can_turn) {
      warn_of_no_direction(node, "light");
    } else {
      out.push_back(light);
    }
  }
  return out;
}

void convert_lights(const GltfObject& root, LightUnits units, std::vector<PunctualLight>& lights,
                    Warnings& warnings) {
  if (lights.empty()) return;
  const std::string generator = root.object("asset")->string("generator", "");
  // "Khronos glTF Blender I/O v4.5.32". From 3.6 on its lighting mode "Standard" is the default.
  constexpr std::string_view blender = "Khronos glTF Blender I/O v";
  const bool multiplies =
      generator.starts_with(blender) && is_version_from(generator.substr(blender.size()), 3, 6);
  if (units == LightUnits::file && multiplies) {
    warnings.once(
        "the lights were written by " + in_quotes(generator) +
        ", which multiplies watts by 683 lm/W (its lighting mode Standard): they are read 1:1; "
        "the job's \"light_units\": \"photometric\" divides by 683, \"radiometric\" is right for "
        "the mode Unitless and ends this warning");
  }
  if (units != LightUnits::photometric) return;
  constexpr float lumens_per_watt = 683;
  for (PunctualLight& light : lights) light.intensity /= lumens_per_watt;
}

}  // namespace lacuna::gltf
