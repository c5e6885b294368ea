#include "jobs/import/pbrt/pbrt_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "jobs/import/pbrt/pbrt_colours.h"
#include "jobs/import/pbrt/pbrt_textures.h"
#include "jobs/import/spot_cone.h"

namespace lacuna::pbrt {
namespace {

struct LightStatement {
  Context& context;
  const Parameters& p;

  /// A colour times `scale`, which pbrt-v3 has as a colour and pbrt-v4 as a number.
  Rgb scaled(const char* name) const {
    const Parameter* c = p.find_spectrum(name);
    const Rgb colour = c == nullptr ? Rgb(1, 1, 1) : emitted_colour(context, *c);
    const Parameter* s = p.find_spectrum("scale");
    const Rgb scale = s == nullptr ? Rgb(1, 1, 1) * static_cast<float>(p.number("scale", 1))
                                   : emitted_colour(context, *s);
    return colour * scale;
  }
  /// pbrt-v4's `power` or `illuminance`, if above 0: the colours above are then those of luminance
  /// 1, so that `scaled()` is to be multiplied by it over `measure`.
  float photometric(const char* name, double measure) const {
    const double value = p.number(name, -1);
    return value > 0 ? static_cast<float>(value / measure) : 1.0F;
  }
  void approximated(const std::string& how) const {
    context.approximated(p.place(), p.owner(), how);
  }
};

V3d direction_of(const V3d& v, const M44d& to_world) {
  V3d out;
  to_world.multDirMatrix(v, out);
  return out.normalized();
}

void point_light(const LightStatement& s, ImportedScene& scene, const M44d& to_world) {
  ImportedLight light;
  light.intensity = s.scaled("I") * s.photometric("power", 4 * std::numbers::pi);
  light.position = s.p.point("from", V3d(0, 0, 0)) * to_world;
  scene.lights.push_back(light);
}

/// Between the cones pbrt-v4 has smoothstep(cos) and pbrt-v3 the fourth power, glTF a square of the
/// same ramp. The inner cone is chosen so that the flux is that of the file: means of the ramps are
/// 1/2, 1/5 and 1/3.
void spot_light(const LightStatement& s, ImportedScene& scene, const M44d& to_world) {
  ImportedLight light;
  light.kind = ImportedLight::Kind::spot;
  const double angle = s.p.number_in("coneangle", 30, 0, 90) * std::numbers::pi / 180;
  const double ramp = s.p.number("conedeltaangle", 5) * std::numbers::pi / 180;
  if (!(angle > 0) || ramp < 0) {
    fail(s.p.place(),
         fmt::format("{}: allowed: coneangle above 0, conedeltaangle 0 and more", s.p.owner()));
  }
  const double end = std::cos(angle), start = std::cos(std::max(angle - ramp, 0.0));
  const double flux = (1 - start) + (start - end) * (s.context.is_v3() ? 0.2 : 0.5);
  light.outer_cone = angle;
  light.inner_cone = spot_inner_cone(flux, end);
  light.intensity = s.scaled("I") * s.photometric("power", 2 * std::numbers::pi *
                                                               ((1 - start) + (start - end) / 2));
  const V3d from = s.p.point("from", V3d(0, 0, 0)), to = s.p.point("to", V3d(0, 0, 1));
  if (from == to) fail(s.p.place(), fmt::format("{}: from is to", s.p.owner()));
  light.position = from * to_world;
  light.direction = direction_of(to - from, to_world);
  if (ramp > 0) s.approximated("glTF's fall-off towards the rim, of the same flux");
  scene.lights.push_back(light);
}

void distant_light(const LightStatement& s, ImportedScene& scene, const M44d& to_world) {
  ImportedLight light;
  light.kind = ImportedLight::Kind::directional;
  light.intensity = s.scaled("L") * s.photometric("illuminance", 1);
  const V3d from = s.p.point("from", V3d(0, 0, 0)), to = s.p.point("to", V3d(0, 0, 1));
  if (from == to) fail(s.p.place(), fmt::format("{}: from is to", s.p.owner()));
  light.direction = direction_of(to - from, to_world);
  scene.lights.push_back(light);
}

void infinite_light(const LightStatement& s, ImportedScene& scene, const M44d& to_world) {
  ImportedEnvironment e;
  e.place = s.p.place().text();
  e.scale = s.scaled("L");
  s.p.ignore({"samples", "nsamples"});
  if (s.p.find("portal", {"point3"}) != nullptr) {
    s.context.left_out(s.p.place(), s.p.owner(), "the portal: light comes from all directions");
  }
  std::string file = s.p.text("filename", "");
  if (file.empty()) file = s.p.text("mapname", "");
  if (!file.empty()) {
    const auto path = s.context.find_file(file, s.p.place(), s.p.owner());
    if (!path) return;
    e.file = *path;
    // pbrt-v4 refuses pictures that are not square.
    e.layout = s.context.is_v3() ? ImportedEnvironment::Layout::equirectangular
                                 : ImportedEnvironment::Layout::equal_area;
    if (s.p.number("illuminance", -1) > 0) {
      s.context.left_out(s.p.place(), s.p.owner(), "illuminance of a picture");
    }
  } else {
    e.scale *= s.photometric("illuminance", std::numbers::pi);
  }
  // In the light's coordinates the azimuth of a column is 2 pi u from +x, in those of
  // the environment pi - 2 pi u.
  M44d mirror;
  mirror.setScale(V3d(-1, 1, 1));
  e.to_world = mirror * to_world;
  if (!scene.environment) {
    scene.environment = e;
  } else if (e.file.empty() && scene.environment->file.empty()) {
    scene.environment->scale += e.scale;
  } else if (scene.environment->file.empty()) {
    s.context.left_out(s.p.place(), s.p.owner(), "a uniform one beside a picture");
    scene.environment = e;
  } else {
    s.context.left_out(s.p.place(), s.p.owner(), "a second one");
  }
}

}  // namespace

void read_light(Context& context, ImportedScene& scene, const std::string& type,
                const Parameters& parameters, const M44d& to_world) {
  const LightStatement s{context, parameters};
  if (type == "point") {
    point_light(s, scene, to_world);
  } else if (type == "spot") {
    spot_light(s, scene, to_world);
  } else if (type == "distant") {
    distant_light(s, scene, to_world);
  } else if (type == "infinite" || type == "exinfinite") {
    infinite_light(s, scene, to_world);
  } else if (type == "goniometric" || type == "projection") {
    for (const Parameter& p : parameters.all()) p.used = true;
    context.left_out(parameters.place(), parameters.owner(), "a light of this type");
  } else {
    fail(parameters.place(),
         fmt::format("light \"{}\"; allowed: point, spot, distant, infinite, and left out: "
                     "goniometric, projection",
                     type));
  }
  context.note_unused(parameters);
}

AreaLight area_light(Context& context, const Parameters& parameters,
                     const std::function<Areas()>& find_areas, bool of_triangles) {
  const LightStatement s{context, parameters};
  AreaLight out;
  out.radiance.value = s.scaled("L");
  out.two_sided = parameters.boolean("twosided", false);
  parameters.ignore({"samples", "nsamples"});
  const std::string file = parameters.text("filename", "");
  if (!file.empty()) {
    if (const auto texture = picture(context, parameters, file)) out.radiance.texture = texture;
  }
  if (parameters.number("power", -1) > 0) {
    const Areas areas = find_areas();
    // Each triangle is a light of its own, and has the power.
    const double area = of_triangles ? (areas.least + areas.most) / 2 : areas.total;
    if (of_triangles && areas.most > 1.001 * areas.least) {
      s.approximated("the power of triangles of different sizes is that of one between them");
    }
    if (!file.empty()) s.approximated("the power is that of a white picture");
    out.radiance.value *= s.photometric("power", area * std::numbers::pi * (out.two_sided ? 2 : 1));
  }
  context.note_unused(parameters);
  return out;
}

}  // namespace lacuna::pbrt
