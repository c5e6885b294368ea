#include "jobs/import/mitsuba/sensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/json/json_cursor.h"
#include "renderer/core/bounds.h"

namespace lacuna::mitsuba {
namespace {

constexpr int most_pixels = 16384;

ImportedPicture picture_of(ReadContext& context, const Parameters& sensor) {
  ImportedPicture picture;
  picture.resolution = {768, 576};
  const auto films = sensor.objects("film");
  if (films.empty()) return picture;
  const Parameters p = context.parameters(*films[0]);
  picture.resolution = {p.integer("width", 768), p.integer("height", 576)};
  for (const int side : picture.resolution) {
    if (side < 1 || side > most_pixels) films[0]->fail("allowed: 1 to 16384 pixels a side");
  }
  const std::array<int, 2> from{p.integer("cropoffsetx", 0), p.integer("cropoffsety", 0)},
      size{p.integer("cropwidth", picture.resolution[0]),
           p.integer("cropheight", picture.resolution[1])};
  if (size != picture.resolution) {
    for (const std::size_t i : {0U, 1U}) {
      if (from[i] < 0 || size[i] < 1 || from[i] + size[i] > picture.resolution[i]) {
        films[0]->fail("has a crop that is not within its picture");
      }
    }
    picture.crop_from = from;
    picture.crop_size = size;
  }
  for (const SceneElement* filter : p.objects("rfilter")) {
    const Parameters f = context.parameters(*filter);
    picture.tent_filter = filter->type() == "tent" && f.number("radius", 1) == 1;
    const bool box = filter->type() == "box" && f.number("radius", .5) == .5;
    f.ignore_all();
    if (!box && !picture.tent_filter) {
      context.note(*filter, "left out", "the job's pixel_filter is a box; it can be a tent");
    }
  }
  p.ignore_all();
  return picture;
}

/// Tangent of half the vertical field of view.
double vertical_tangent(const Parameters& p, double aspect) {
  if (!p.has("fov")) {
    const std::string text = p.text("focallength", "50mm");
    std::string_view digits = text;
    if (digits.ends_with("mm")) digits.remove_suffix(2);
    const double millimetres = number_in(p.element(), std::string(digits));
    if (!(millimetres > 0)) p.element().fail("has a focal length that is not above 0");
    // Of a film of 36 x 24 mm, along its diagonal.
    const double diagonal = std::hypot(36.0, 24.0) / (2 * millimetres);
    return diagonal / std::sqrt(1 + aspect * aspect);
  }
  p.ignore({"focallength"});
  const double fov = p.number("fov", 45);
  if (!(fov > 0 && fov < 180)) p.element().fail("has a fov outside of 0 to 180 degrees");
  const double tangent = std::tan(fov / 2 * degree);
  std::string axis = p.text("fovaxis", "x");
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  if (axis == "x") return tangent / aspect;
  if (axis == "y") return tangent;
  if (axis == "diagonal") return tangent / std::sqrt(1 + aspect * aspect);
  p.element().fail(
      fmt::format("has the fovAxis {}; allowed: x, y, diagonal, smaller, larger", in_quotes(axis)));
}

/// Mitsuba's camera looks along +z with +x to the left; ours along -z with +x to the right. Unit
/// axes; `scales` are the lengths of Mitsuba's.
M44d camera_frame(const Parameters& p, std::array<double, 3>& scales) {
  const M44d m = p.transform("toworld");
  M44d out;
  for (int i = 0; i < 3; ++i) {
    const V3d axis(m[i][0], m[i][1], m[i][2]);
    scales[static_cast<std::size_t>(i)] = axis.length();
    if (!(axis.length() > 0)) p.element().fail("has a toWorld that is singular");
    const double sign = i == 1 ? 1 : -1;
    for (int k = 0; k < 3; ++k) out[i][k] = sign * axis[k] / axis.length();
  }
  for (int k = 0; k < 3; ++k) out[3][k] = m[3][k];
  return out;
}

/// The type that stands for another one; empty: none does.
std::string nearest_type(ReadContext& context, const SceneElement& element) {
  const std::string& type = element.type();
  if (type == "perspective" || type == "thinlens" || type == "orthographic" ||
      type == "spherical") {
    return type;
  }
  if (type == "telecentric") {
    context.note(element, "approximated", "an orthographic camera, without a lens");
    return "orthographic";
  }
  if (type == "perspective_rdist") {
    context.note(element, "approximated", "a perspective camera, without radial distortion");
    return "perspective";
  }
  context.note(element, "left out",
               "sensors that are read: perspective, thinlens, orthographic, spherical");
  return "";
}

}  // namespace

void add_sensor(ReadContext& context, const SceneElement& element, ImportedScene& scene) {
  const Parameters p = context.parameters(element);
  if (element.type() == "batch") {
    for (const SceneElement* inner : p.objects("sensor")) add_sensor(context, *inner, scene);
    return p.ignore_all();
  }
  const std::string type = nearest_type(context, element);
  if (type.empty()) return p.ignore_all();
  const ImportedPicture picture = picture_of(context, p);
  const double aspect = static_cast<double>(picture.resolution[0]) / picture.resolution[1];
  ImportedCamera camera;
  camera.place = element.place;
  camera.name =
      element.has("id")
          ? element.attribute("id")
          : fmt::format("camera{}",
                        scene.cameras.empty() ? "" : std::to_string(scene.cameras.size() + 1));
  std::array<double, 3> scales{1, 1, 1};
  camera.to_world = camera_frame(p, scales);
  if (type == "spherical") {
    camera.projection = Projection::panorama;
  } else if (type == "orthographic") {
    camera.projection = Projection::orthographic;
    camera.height = 2 * scales[0] / aspect;
    if (std::abs(scales[1] / scales[0] - 1) > 1e-4) {
      context.note(element, "approximated", "its pixels, which are not square, become square");
    }
  } else {
    camera.yfov = 2 * std::atan(vertical_tangent(p, aspect));
  }
  if (type == "thinlens") {
    camera.aperture = p.number("apertureradius", 0);
    camera.focus = p.number("focusdistance", 0);
    if (!(camera.aperture >= 0)) element.fail("has an aperture below 0");
    if (camera.aperture > 0 && !(camera.focus > 0)) element.fail("has no focusDistance above 0");
  }
  constexpr double default_near = .01;
  if (p.number("nearclip", default_near) > default_near) {
    context.note(element, "left out", "nearClip: what is nearer is seen");
  }
  p.ignore({"farclip", "focusdistance", "shutteropen", "shutterclose"});
  if (type != element.type()) p.ignore({"apertureradius", "kc"});
  for (const char* shift : {"principalpointoffsetx", "principalpointoffsety"}) {
    if (p.number(shift, 0) != 0) context.note(element, "left out", fmt::format("its {}", shift));
  }
  for (const SceneElement* sampler : p.objects("sampler")) {
    context.parameters(*sampler).ignore_all();
  }
  p.note_unread(context.notes);
  if (scene.cameras.empty()) {
    const auto depth = scene.picture.max_depth;
    scene.picture = picture;
    scene.picture.max_depth = depth;
  }
  scene.cameras.push_back(camera);
}

void add_default_sensor(ReadContext& context, const SceneElement& root, ImportedScene& scene) {
  Bounds bounds;
  for (const ImportedShape& shape : scene.shapes) {
    for (const V3f& x : shape.mesh->positions) bounds.add(V3d(x) * shape.to_world);
  }
  if (bounds.empty()) return;
  const V3d centre = (bounds.low + bounds.high) / 2, size = bounds.size();
  constexpr double fov = 45 * degree;  // along x, as of Mitsuba 3's default sensor
  const double extent = std::max({size.x, size.y, size.z});
  ImportedCamera camera;
  camera.name = "camera";
  camera.place = root.place;
  scene.picture.resolution = {768, 576};
  camera.yfov = 2 * std::atan(std::tan(fov / 2) * 576 / 768);
  // Looks along +z with y up: x to the left.
  const double z = bounds.low.z - extent / (2 * std::tan(fov / 2));
  camera.to_world = M44d(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, centre.x, centre.y, z, 1);
  scene.cameras.push_back(camera);
  context.note(root, "approximated",
               "it has no sensor: a camera of 45 degrees that sees all shapes along +z");
}

void read_integrator(ReadContext& context, const SceneElement& element, ImportedScene& scene) {
  const Parameters p = context.parameters(element);
  for (const SceneElement* inner : p.objects("integrator")) {
    read_integrator(context, *inner, scene);
  }
  if (element.type().starts_with("direct")) scene.picture.max_depth = 2;
  if (p.has("maxdepth")) {
    const int depth = p.integer("maxdepth", -1);
    if (depth > 0) scene.picture.max_depth = depth;
  }
  for (const char* changes : {"hideemitters", "strictnormals"}) {
    if (p.boolean(changes, false)) {
      context.note(element, "left out", fmt::format("its {}", changes));
    }
  }
  const std::string& type = element.type();
  if (type != "path" && type != "volpath" && type != "volpath_simple" && type != "bdpt") {
    context.note(element, "left out", "its method: the job renders by path, with its depth");
  }
  p.ignore_all();
}

}  // namespace lacuna::mitsuba
