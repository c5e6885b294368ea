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

Rgb rgb_of_pairs(const SceneElement& at, const std::vector<double>& wavelengths,
                 const std::vector<double>& values) {
  if (wavelengths.size() != values.size()) at.fail("allowed: pairs of wavelength and value");
  Spectrum spectrum;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!spectrum.empty() && !(wavelengths[i] > spectrum.back().first)) {
      at.fail("allowed: wavelengths that grow");
    }
    spectrum.emplace_back(wavelengths[i], values[i]);
  }
  Rgb rgb = rgb_of_spectrum(spectrum, EqualEnergy::coloured);
  for (int c = 0; c < 3; ++c) rgb[c] = std::max(0.0F, rgb[c]);
  return rgb;
}

constexpr std::size_t most_samples = 1 << 16;

/// `400:0.1, 500:0.2`.
Rgb rgb_of_list(const SceneElement& at, std::string text) {
  std::replace(text.begin(), text.end(), ':', ' ');
  const auto n = numbers_in(at, text, 2 * most_samples);
  if (n.size() % 2 != 0) at.fail("allowed: pairs of wavelength:value");
  std::vector<double> wavelengths, values;
  for (std::size_t i = 0; i < n.size(); ++i) (i % 2 == 0 ? wavelengths : values).push_back(n[i]);
  return rgb_of_pairs(at, wavelengths, values);
}

/// The value of a child of a spectrum plugin, by its plain name.
const std::string* child_value(const SceneElement& e, std::string_view name) {
  for (const SceneElement& child : e.children) {
    if (child.name() != name) continue;
    child.read = true;
    return &child.attribute("value");
  }
  return nullptr;
}

double child_number(const SceneElement& e, std::string_view name, double fallback) {
  const std::string* text = child_value(e, name);
  return text == nullptr ? fallback : number_in(e, *text);
}

Rgb rgb_of_blackbody(const SceneElement& e) {
  std::string kelvin = e.attribute(e.has("temperature") ? "temperature" : "value");
  if (kelvin.ends_with('K') || kelvin.ends_with('k')) kelvin.pop_back();
  const double temperature = number_in(e, kelvin);
  if (!(temperature > 0 && temperature <= 1e6)) e.fail("allowed: above 0, at most 1e6 kelvin");
  const double scale = e.has("scale") ? number_in(e, e.attribute("scale")) : 1;
  return blackbody_rgb(temperature) * static_cast<float>(scale);
}

/// The spectra of Mitsuba 3 that are plugins, in its RGB mode: d65 is white.
Rgb rgb_of_plugin(const SceneElement& e) {
  const std::string& type = e.type();
  if (type == "d65") return Rgb(static_cast<float>(child_number(e, "scale", 1)));
  if (type == "uniform") return Rgb(static_cast<float>(child_number(e, "value", 1)));
  if (type == "blackbody") {
    const double kelvin = child_number(e, "temperature", 5000);
    if (!(kelvin > 0 && kelvin <= 1e6)) e.fail("allowed: above 0, at most 1e6 kelvin");
    return blackbody_rgb(kelvin) * static_cast<float>(child_number(e, "scale", 1));
  }
  if (type == "srgb" || type == "srgb_d65") {
    for (const SceneElement& child : e.children) {
      if (child.name() != "color") continue;
      child.read = true;
      const float scale = static_cast<float>(child_number(e, "scale", 1));
      if (const auto colour = color_of(child)) return *colour * scale;
    }
  }
  if (type == "rawconstant") return Rgb(static_cast<float>(child_number(e, "value", 1)));
  const std::string* values = child_value(e, "values");
  if ((type != "regular" && type != "irregular") || values == nullptr) {
    e.fail(
        "is a spectrum that is not read; allowed: d65, uniform, blackbody, srgb and srgb_d65 with "
        "a color, rawconstant, regular and irregular with values");
  }
  const auto samples = numbers_in(e, *values, most_samples);
  std::vector<double> wavelengths;
  if (type == "irregular") {
    const std::string* at = child_value(e, "wavelengths");
    wavelengths = numbers_in(e, at == nullptr ? "" : *at, most_samples);
  } else {
    const double from = child_number(e, "wavelengthmin", 360),
                 to = child_number(e, "wavelengthmax", 830);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double t = samples.size() < 2 ? 0 : static_cast<double>(i) / (samples.size() - 1.0);
      wavelengths.push_back(from + (to - from) * t);
    }
  }
  return rgb_of_pairs(e, wavelengths, samples);
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
  if (!e.type().empty()) return rgb_of_plugin(e);
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
