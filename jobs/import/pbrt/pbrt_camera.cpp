#include "jobs/import/pbrt/pbrt_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacuna::pbrt {
namespace {

constexpr int max_side = 32768;  // pixels

/// The film in pixels, and the part of it that is rendered: left, right, top, bottom.
struct Film {
  std::array<int, 2> size{1280, 720};
  std::array<int, 4> crop{0, 0, 0, 0};
  double exposure = 1;
};

Film read_film(Context& context, const RenderOptions& options) {
  Film out;
  if (context.is_v3()) out.size = {640, 480};
  if (!options.film) {
    out.crop = {0, out.size[0], 0, out.size[1]};
    return out;
  }
  const Parameters& p = options.film->parameters;
  out.size = {p.integer("xresolution", out.size[0], 1, max_side),
              p.integer("yresolution", out.size[1], 1, max_side)};
  out.crop = {0, out.size[0], 0, out.size[1]};
  const auto window = p.groups("cropwindow", 4, {"float"});
  const auto bounds = p.groups("pixelbounds", 4, {"integer"});
  for (std::size_t i = 0; i < 4; ++i) {
    const double side = out.size[i / 2];
    if (!window.empty())
      out.crop[i] = static_cast<int>(std::ceil(std::clamp(window[i], 0.0, 1.0) * side));
    if (!bounds.empty()) out.crop[i] = static_cast<int>(std::clamp(bounds[i], 0.0, side));
  }
  if (out.crop[0] >= out.crop[1] || out.crop[2] >= out.crop[3]) {
    fail(p.place(), fmt::format("{}: the crop window is empty", p.owner()));
  }
  out.exposure = p.number("scale", 1) * p.number("iso", 100) / 100;
  const std::string sensor = p.text("sensor", "cie1931");
  if (sensor != "cie1931") {
    context.approximated(p.place(), p.owner(),
                         fmt::format("sensor \"{}\" is that of CIE 1931, linear sRGB", sensor));
  }
  const double white = p.number("whitebalance", 0);
  if (white != 0) context.left_out(p.place(), p.owner(), "white balance");
  const double limit =
      std::min(p.number("maxcomponentvalue", INFINITY), p.number("maxsampleluminance", INFINITY));
  if (std::isfinite(limit)) {
    context.left_out(p.place(), p.owner(), fmt::format("the limit of a sample's value, {}", limit));
  }
  p.ignore({"filename", "diagonal", "savefp16", "nbuckets", "lambdamin", "lambdamax",
            "coordinatesystem"});
  context.note_unused(p);
  return out;
}

/// The edges of the screen that the film shows: x from, to, y from, to.
std::array<double, 4> screen_of(const Parameters& p, double aspect) {
  const auto window = p.groups("screenwindow", 4, {"float"});
  if (!window.empty()) {
    if (window[0] < window[1] && window[2] < window[3]) {
      return {window[0], window[1], window[2], window[3]};
    }
    fail(p.place(), fmt::format("{}: the screen window is empty", p.owner()));
  }
  aspect = p.number("frameaspectratio", aspect);
  if (!(aspect > 0)) fail(p.place(), fmt::format("frameaspectratio {}; allowed: above 0", aspect));
  if (aspect > 1) return {-aspect, aspect, -1, 1};
  return {-1, 1, -1 / aspect, 1 / aspect};
}

/// The whole picture is that of a screen which is symmetric about the axis; the film is a crop of
/// it. Returns half of its height.
double set_picture(Context& context, const Parameters& p, const Film& film,
                   const std::array<double, 4>& screen, ImportedPicture& picture) {
  const double pixel = (screen[1] - screen[0]) / film.size[0];
  const double pixel_y = (screen[3] - screen[2]) / film.size[1];
  if (std::abs(pixel_y - pixel) > 1e-3 * pixel) {
    context.approximated(p.place(), p.owner(),
                         fmt::format("pixels of {:.4g} by {:.4g} are square", pixel, pixel_y));
  }
  const double half_x = std::max(-screen[0], screen[1]);
  const double half_y = std::max(-screen[2], screen[3]);
  const auto pixels = [](double x, double per) { return static_cast<int>(std::lround(x / per)); };
  // Columns to the left of the film, rows above it.
  const int left = pixels(half_x + screen[0], pixel), top = pixels(half_y - screen[3], pixel_y);
  picture.resolution = {pixels(2 * half_x, pixel), pixels(2 * half_y, pixel_y)};
  if (half_x <= 0 || half_y <= 0 || picture.resolution[0] > max_side ||
      picture.resolution[1] > max_side) {
    fail(p.place(), fmt::format("{}: the screen window is too far from the axis", p.owner()));
  }
  const auto& c = film.crop;
  const bool is_whole =
      c[0] == 0 && c[2] == 0 && c[1] == picture.resolution[0] && c[3] == picture.resolution[1];
  if (!is_whole) {
    picture.crop_from = {left + c[0], top + c[2]};
    picture.crop_size = {std::min(c[1] - c[0], picture.resolution[0] - left - c[0]),
                         std::min(c[3] - c[2], picture.resolution[1] - top - c[2])};
  }
  return half_y;
}

/// The camera's axes and scale from its transform.
void place_camera(Context& context, const Parameters& p, const M44d& world_from_camera,
                  bool panorama, View& view, double& scale) {
  const auto row = [&](int i) {
    return V3d(world_from_camera[i][0], world_from_camera[i][1], world_from_camera[i][2]);
  };
  // A picture of pbrt's panorama is seen from outside: right in it is ahead x up.
  const V3d x = row(0), y = row(1), z = row(2);
  view.mirrored = (z.cross(y).dot(x) < 0) != panorama;
  scale = z.length();
  const double skew = std::max({std::abs(x.dot(y)), std::abs(y.dot(z)), std::abs(z.dot(x)),
                                std::abs(x.dot(x) - z.dot(z)), std::abs(y.dot(y) - z.dot(z))});
  if (skew > 1e-6 * z.dot(z)) {
    context.approximated(p.place(), p.owner(), "the camera's transform stretches or shears");
  }
  const double side = view.mirrored ? -1 : 1;
  const auto world = [&](V3d v) { return V3d(side * v.x, v.y, v.z); };
  // The centre of a panorama is at -x of pbrt's camera, its right at -z.
  const V3d back = world(panorama ? x : -z).normalized();
  const V3d up = (world(y) - back * world(y).dot(back)).normalized();
  const V3d right = up.cross(back);
  const V3d at = world(row(3));
  view.camera.to_world = M44d(right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y,
                              back.z, 0, at.x, at.y, at.z, 1);
}

/// Type, field of view and lens.
void read_camera(Context& context, const Statement& camera, const Film& film, View& view,
                 double scale, const Parameters& p) {
  const std::string& type = camera.type;
  ImportedCamera& out = view.camera;
  const std::array<double, 4> screen = screen_of(p, double(film.size[0]) / film.size[1]);
  const double half_height = set_picture(context, p, film, screen, view.picture);
  if (type == "orthographic") {
    out.projection = Projection::orthographic;
    out.height = 2 * half_height * scale;
  } else {
    const double fov = p.number("halffov") ? 2 * p.number("halffov", 45) : p.number("fov", 90);
    if (!(fov > 0 && fov < 180)) {
      fail(p.place(), fmt::format("{}: fov {}; allowed: between 0 and 180", p.owner(), fov));
    }
    out.yfov = 2 * std::atan(std::tan(fov * std::numbers::pi / 360) * half_height);
  }
  out.aperture = p.number("lensradius", 0) * scale;
  out.focus = p.number("focaldistance", 1e6) * scale;
  if (out.aperture > 0 && type == "orthographic") {
    context.left_out(p.place(), p.owner(), "the lens of an orthographic camera");
    out.aperture = 0;
  }
}

void read_realistic(Context& context, const Parameters& p, const Film& film, View& view) {
  for (const Parameter& x : p.all()) x.used = true;
  context.approximated(
      p.place(), p.owner(),
      "a pinhole with a vertical field of view of 40 degrees instead of the lenses");
  view.camera.yfov = 40 * std::numbers::pi / 180;
  set_picture(context, p, film, screen_of(Parameters(), double(film.size[0]) / film.size[1]),
              view.picture);
}

/// pbrt counts the scattering events of a path, the job its edges.
std::optional<int> read_depth(Context& context, const RenderOptions& options) {
  constexpr int by_default = 5;
  if (!options.integrator) return by_default + 1;
  const Parameters& p = options.integrator->parameters;
  const int depth = p.integer("maxdepth", by_default, 0, 1 << 20);
  if (p.boolean("regularize", false)) {
    context.left_out(p.place(), p.owner(), "\"regularize\", which widens glossy lobes");
  }
  for (const Parameter& x : p.all()) x.used = true;  // of a method; the job's is path tracing
  const std::string& type = options.integrator->type;
  if (type == "ao" || type == "ambientocclusion" || type == "whitted" || type == "directlighting" ||
      type == "randomwalk" || type == "function" || type == "lightpath") {
    context.approximated(
        p.place(), p.owner(),
        fmt::format("path tracing of {} edges instead of this integrator", depth + 1));
  }
  return depth + 1;
}

}  // namespace

View read_view(Context& context, const RenderOptions& options) {
  View view;
  const Film film = read_film(context, options);
  const Statement camera =
      options.camera.value_or(Statement{"perspective", Parameters().copy_for({}, "Camera")});
  const Parameters& p = camera.parameters;
  const bool panorama = camera.type == "spherical" || camera.type == "environment";
  double scale = 1;
  place_camera(context, p, options.world_from_camera, panorama, view, scale);
  view.camera.name = "camera";
  view.camera.place = p.place().text();
  if (panorama) {
    view.camera.projection = Projection::panorama;
    if (camera.type == "spherical" && p.text("mapping", "equalarea") != "equirectangular") {
      context.approximated(p.place(), p.owner(),
                           "an equirectangular picture instead of equal areas");
    }
    p.ignore({"frameaspectratio", "screenwindow", "lensradius", "focaldistance"});
    const double half = double(film.size[1]) / film.size[0];
    set_picture(context, p, film, {-1, 1, -half, half}, view.picture);
  } else if (camera.type == "perspective" || camera.type == "orthographic") {
    read_camera(context, camera, film, view, scale, p);
  } else if (camera.type == "realistic") {
    read_realistic(context, p, film, view);
  } else {
    fail(p.place(), fmt::format("camera \"{}\"; allowed: perspective, orthographic, spherical, "
                                "environment, realistic",
                                camera.type));
  }
  view.exposure = static_cast<float>(film.exposure);
  const double open = p.number("shutteropen", 0), close = p.number("shutterclose", 1);
  if (!context.is_v3() && close > open) view.exposure *= static_cast<float>(close - open);
  context.note_unused(p);
  view.picture.max_depth = read_depth(context, options);
  view.picture.tent_filter = options.tent_filter;
  return view;
}

}  // namespace lacuna::pbrt
