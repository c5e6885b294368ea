#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/json/json_cursor.h"
#include "jobs/import/mitsuba/parameters.h"
#include "jobs/import/spectrum.h"

namespace lacuna::mitsuba {
namespace {

double srgb_to_linear_value(double c) {  // IEC 61966-2-1
  return c <= .04045 ? c / 12.92 : std::pow((c + .055) / 1.055, 2.4);
}

Rgb rgb_of_numbers(const SceneElement& at, const std::vector<double>& n) {
  if (n.size() == 1) return Rgb(static_cast<float>(n[0]));
  if (n.size() != 3) at.fail("allowed: one or three numbers");
  return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
}

/// `#rrggbb`, in sRGB.
Rgb rgb_of_hex(const SceneElement& at, const std::string& text) {
  if (text.size() != 7 ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) {
    at.fail(fmt::format("has {}; allowed: #rrggbb", in_quotes(text)));
  }
  Rgb rgb;
  for (int c = 0; c < 3; ++c) {
    const int code = std::stoi(text.substr(static_cast<std::size_t>(1 + 2 * c), 2), nullptr, 16);
    rgb[c] = static_cast<float>(srgb_to_linear_value(code / 255.0));
  }
  return rgb;
}

/// `400:0.1, 500:0.2`.
Rgb rgb_of_list(const SceneElement& at, std::string text) {
  std::replace(text.begin(), text.end(), ':', ' ');
  const auto n = numbers_in(at, text, 1 << 16);
  if (n.size() % 2 != 0) at.fail("allowed: pairs of wavelength:value");
  Spectrum spectrum;
  for (std::size_t i = 0; i < n.size(); i += 2) {
    if (!spectrum.empty() && !(n[i] > spectrum.back().first)) {
      at.fail("allowed: wavelengths that grow");
    }
    spectrum.emplace_back(n[i], n[i + 1]);
  }
  Rgb rgb = rgb_of_spectrum(spectrum, EqualEnergy::coloured);
  for (int c = 0; c < 3; ++c) rgb[c] = std::max(0.0F, rgb[c]);
  return rgb;
}

Rgb rgb_of_blackbody(const SceneElement& e) {
  std::string kelvin = e.attribute(e.has("temperature") ? "temperature" : "value");
  if (kelvin.ends_with('K') || kelvin.ends_with('k')) kelvin.pop_back();
  const double temperature = number_in(e, kelvin);
  if (!(temperature > 0 && temperature <= 1e6)) e.fail("allowed: above 0, at most 1e6 kelvin");
  const double scale = e.has("scale") ? number_in(e, e.attribute("scale")) : 1;
  return blackbody_rgb(temperature) * static_cast<float>(scale);
}

V3d axes_of(const SceneElement& e, double fallback) {
  const auto at = [&](const char* axis) {
    return e.has(axis) ? number_in(e, e.attribute(axis)) : fallback;
  };
  if (!e.has("value")) return {at("x"), at("y"), at("z")};
  const auto n = numbers_in(e, e.attribute("value"), 3);
  if (n.size() == 1) return V3d(n[0]);
  if (n.size() != 3) e.fail("allowed: one or three numbers");
  return {n[0], n[1], n[2]};
}

V3d point_attribute(const SceneElement& e, const char* name) {
  const auto n = numbers_in(e, e.attribute(name), 3);
  if (n.size() != 3) e.fail(fmt::format("its {} is to be three numbers", name));
  return {n[0], n[1], n[2]};
}

M44d rotation_of(const SceneElement& e) {
  const V3d axis = axes_of(e, 0);
  if (!(axis.length() > 0)) e.fail("its axis is 0");
  M44d m;
  m.setAxisAngle(axis.normalized(), number_in(e, e.attribute("angle")) * degree);
  return m;
}

/// Local +z looks at the target, +x is left, +y up.
M44d look_at(const SceneElement& e) {
  const V3d origin = point_attribute(e, "origin"), target = point_attribute(e, "target");
  const V3d z = (target - origin).normalized();
  V3d up(0, 1, 0);
  if (e.has("up")) {
    up = point_attribute(e, "up");
  } else if (std::abs(z.y) > .9) {
    up = {1, 0, 0};
  }
  const V3d x = up.cross(z).normalized(), y = z.cross(x);
  if (!(z.length() > 0 && x.length() > 0)) e.fail("its target is its origin, or up is along it");
  return {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1};
}

M44d matrix_of(const SceneElement& e) {
  const auto n = numbers_in(e, e.attribute("value"), 16);
  if (n.size() != 16 && n.size() != 9) e.fail("allowed: 16 or 9 numbers");
  const std::size_t side = n.size() == 16 ? 4 : 3;
  M44d m;
  for (std::size_t row = 0; row < side; ++row) {  // ours has row vectors
    for (std::size_t column = 0; column < side; ++column) {
      m[static_cast<int>(column)][static_cast<int>(row)] = n[row * side + column];
    }
  }
  return m;
}

M44d step_of(const SceneElement& e) {
  const std::string tag = plain_name(e.tag);
  M44d m;
  if (tag == "translate") {
    m.setTranslation(axes_of(e, 0));
  } else if (tag == "scale") {
    m.setScale(axes_of(e, 1));
  } else if (tag == "rotate") {
    m = rotation_of(e);
  } else if (tag == "lookat") {
    m = look_at(e);
  } else if (tag == "matrix") {
    m = matrix_of(e);
  } else {
    e.fail("is no transform; allowed: translate, scale, rotate, lookat, matrix");
  }
  return m;
}

}  // namespace

std::optional<Rgb> color_of(const SceneElement& e) {
  const std::string& text = e.attribute("value");
  if (e.tag == "float" || e.tag == "integer") {
    return Rgb(static_cast<float>(number_in(e, text)));
  }
  if (e.tag == "blackbody") return rgb_of_blackbody(e);
  const bool spectrum = e.tag == "spectrum" || e.tag == "color";
  if (e.tag != "rgb" && e.tag != "srgb" && !spectrum) return {};
  if (e.has("filename")) e.fail("is a file, which is not read; allowed: its values");
  if (!e.type().empty()) e.fail("is a plugin, which is not read; allowed: values");
  if (e.has("intent")) e.read = true;
  if (text.starts_with('#')) return rgb_of_hex(e, text);
  if (spectrum && text.find(':') != std::string::npos) return rgb_of_list(e, text);
  Rgb rgb = rgb_of_numbers(e, numbers_in(e, text, 3));
  if (e.tag == "srgb") {
    for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(srgb_to_linear_value(double(rgb[c])));
  }
  return rgb;
}

M44d transform_of(const SceneElement& transform) {
  M44d m;
  for (const SceneElement& step : transform.children) {
    step.read = true;
    m = m * step_of(step);
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (!(std::abs(m[i][j]) < 1e30)) transform.fail("has entries above 1e30");
    }
  }
  return m;
}

}  // namespace lacuna::mitsuba
