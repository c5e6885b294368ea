#include "jobs/import/mitsuba/emitters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "jobs/import/spot_cone.h"

namespace lacuna::mitsuba {
namespace {

Rgb strength_of(const Parameters& p, std::string_view name) {
  const auto color = p.color(name);
  if (!color && p.has(name)) {
    p.element().fail(
        fmt::format("has {} that is no colour; allowed: rgb, spectrum, blackbody", name));
  }
  return color.value_or(Rgb(1));
}

V3d direction_in(const M44d& m, const V3d& v) {
  V3d out;
  m.multDirMatrix(v, out);
  return out.normalized();
}

/// Along local +z.
void place_light(const Parameters& p, ImportedLight& light) {
  const M44d m = p.transform("toworld");
  light.position = {m[3][0], m[3][1], m[3][2]};
  if (const auto position = p.vector("position")) light.position = *position;
  light.direction = direction_in(m, {0, 0, 1});
  if (const auto direction = p.vector("direction")) light.direction = direction->normalized();
  if (!(light.direction.length() > 0)) p.element().fail("has a direction of length 0");
}

void add_light(ReadContext& context, const Parameters& p, ImportedScene& scene) {
  const std::string& type = p.element().type();
  ImportedLight light;
  light.name = p.element().attribute("id");
  place_light(p, light);
  if (type == "directional") {
    light.kind = ImportedLight::Kind::directional;
    light.intensity = strength_of(p, "irradiance");
  } else {
    light.intensity = strength_of(p, "intensity");
  }
  if (type == "spot") {
    light.kind = ImportedLight::Kind::spot;
    const double cutoff = p.number("cutoffangle", 20);
    const double beam = p.number("beamwidth", cutoff * 3 / 4);
    if (!(cutoff > 0 && cutoff <= 90 && beam >= 0 && beam <= cutoff)) {
      p.element().fail("allowed: a cutoffAngle above 0, at most 90, and a beamWidth up to that");
    }
    const double inner = beam * degree, outer = cutoff * degree;
    light.inner_cone = inner;
    light.outer_cone = outer;
    if (beam < cutoff) {
      // Linear in the angle: the integral of (outer - t) / (outer - inner) sin t.
      const double flux = 1 - (std::sin(outer) - std::sin(inner)) / (outer - inner);
      light.inner_cone = spot_inner_cone(flux, std::cos(outer));
      context.note(p.element(), "approximated",
                   "glTF's fall-off towards the rim, of the same flux");
    }
  }
  scene.lights.push_back(light);
}

void add_environment(ReadContext& context, const Parameters& p, ImportedScene& scene) {
  if (scene.environment) p.element().fail("is the second environment; allowed: one");
  ImportedEnvironment e;
  e.place = p.element().place;
  if (p.element().type() == "constant") {
    e.scale = strength_of(p, "radiance");
    scene.environment = e;
    return;
  }
  const std::string name = p.text("filename", "");
  const auto file = context.file(p.element(), name);
  e.scale = Rgb(static_cast<float>(p.number("scale", 1)));
  if (p.number("gamma", -1) > 0) {
    context.note(p.element(), "left out", "its gamma: a file of floats is linear, others sRGB");
  }
  // Local: the picture's centre is +z, up +y, its left +x. M44d's rows: centre, left, up.
  const M44d picture(0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  e.to_world = picture * p.transform("toworld");
  p.ignore({"cache"});
  if (!file) {
    context.note(p.element(), "left out", fmt::format("{} is missing", name));
    return;
  }
  e.file = *file;
  scene.environment = e;
}

V3d sun_in(const Parameters& p, const M44d& to_world) {
  if (const auto given = p.vector("sundirection")) {
    V3d local;
    to_world.inverse().multDirMatrix(*given, local);
    return local.normalized();
  }
  PlaceAndTime t;
  t.latitude = p.number("latitude", t.latitude);
  t.longitude = p.number("longitude", t.longitude);
  t.timezone = p.number("timezone", t.timezone);
  t.year = p.integer("year", t.year);
  t.month = p.integer("month", t.month);
  t.day = p.integer("day", t.day);
  t.hours = p.number("hour", t.hours) + (p.number("minute", 0) + p.number("second", 0) / 60) / 60;
  return direction_to_sun(t);
}

/// sky, sun or sunsky.
void add_daylight(ReadContext& context, const Parameters& p, ImportedScene& scene) {
  if (scene.environment) p.element().fail("is the second environment; allowed: one");
  const std::string& type = p.element().type();
  ImportedEnvironment e;
  e.place = p.element().place;
  e.to_world = p.transform("toworld");
  Daylight d;
  d.to_sun = sun_in(p, e.to_world);
  d.turbidity = p.number("turbidity", d.turbidity);
  const double scale = p.number("scale", 1);
  d.sky_scale = type == "sun" ? 0 : p.number("skyscale", scale);
  d.sun_scale = type == "sky" ? 0 : p.number("sunscale", scale);
  d.radius_scale = p.number("sunradiusscale", 1);
  e.daylight_width = p.integer("resolution", e.daylight_width);
  if (!(d.turbidity >= 1 && d.turbidity <= 10)) p.element().fail("allowed: turbidity 1 to 10");
  if (!(d.to_sun.y > 0)) p.element().fail("has its sun below the horizon");
  if (!(d.radius_scale >= 0 && d.radius_scale <= 100)) {
    p.element().fail("allowed: sunRadiusScale 0 to 100");
  }
  if (e.daylight_width < 2 || e.daylight_width > 8192) {
    p.element().fail("allowed: a resolution of 2 to 8192");
  }
  if (d.sky_scale > 0) {
    p.ignore({"albedo"});
    context.note(p.element(), "approximated",
                 "the sky of Preetham, Shirley and Smits (1999), in place of that of Hosek and "
                 "Wilkie (2012); the ground's albedo has no influence");
  }
  if (d.radius_scale == 0 && d.sun_scale > 0) {
    ImportedLight sun;
    sun.kind = ImportedLight::Kind::directional;
    sun.name = "sun";
    sun.direction = -direction_in(e.to_world, d.to_sun);
    sun.intensity =
        sun_radiance(std::acos(d.to_sun.y), d.turbidity) *
        static_cast<float>(d.sun_scale * 2 * std::numbers::pi * (1 - std::cos(sun_radius)));
    scene.lights.push_back(sun);
    d.sun_scale = 0;
  }
  e.daylight = d;
  scene.environment = e;
}

}  // namespace

bool is_of_shapes(const SceneElement& e) {
  return e.type() == "area" || e.type() == "directionalarea";
}

void add_emitter(ReadContext& context, const SceneElement& element, ImportedScene& scene) {
  const Parameters p = context.parameters(element);
  const std::string& type = element.type();
  if (type == "point" || type == "spot" || type == "directional") {
    add_light(context, p, scene);
  } else if (type == "constant" || type == "envmap") {
    add_environment(context, p, scene);
  } else if (type == "sky" || type == "sun" || type == "sunsky") {
    add_daylight(context, p, scene);
  } else {
    context.note(element, "left out",
                 "emitters that are read: area (in a shape), point, spot, directional, constant, "
                 "envmap, sky, sun, sunsky");
    p.ignore_all();
  }
  p.ignore({"samplingweight"});
  p.note_unread(context.notes);
}

}  // namespace lacuna::mitsuba
