#include "jobs/import/pbrt/pbrt_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "jobs/import/input_bytes.h"
#include "jobs/import/spectrum.h"

namespace lacuna::pbrt {
namespace {

Rgb rgb_of_xyz(const V3d& c) {
  // The inverse of the matrix of Rec. 709's primaries and D65.
  return {static_cast<float>(3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z),
          static_cast<float>(-0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z),
          static_cast<float>(0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z)};
}

/// To Rec. 709. Of ACES, with Bradford's adaptation of its white to D65.
Rgb from_space(ColourSpace space, const V3d& c) {
  using Rows = std::array<V3d, 3>;
  constexpr auto dots = [](const Rows& m, const V3d& v) {
    return Rgb(V3f(V3d(m[0].dot(v), m[1].dot(v), m[2].dot(v))));
  };
  switch (space) {
    case ColourSpace::rec2020:
      return dots({V3d(1.660491, -0.587641, -0.072850), V3d(-0.124550, 1.132900, -0.008349),
                   V3d(-0.018151, -0.100579, 1.118730)},
                  c);
    case ColourSpace::dci_p3:
      return dots({V3d(1.224940, -0.224940, 0), V3d(-0.042057, 1.042057, 0),
                   V3d(-0.019638, -0.078636, 1.098274)},
                  c);
    case ColourSpace::aces:
      return dots({V3d(2.521686, -1.134131, -0.387555), V3d(-0.276480, 1.372719, -0.096239),
                   V3d(-0.015378, -0.152975, 1.168353)},
                  c);
    case ColourSpace::srgb:
      break;
  }
  return Rgb(V3f(c));
}

V3d three(const Parameter& p) {
  if (p.numbers.size() == 3) return {p.numbers[0], p.numbers[1], p.numbers[2]};
  fail(p.place, fmt::format("parameter \"{} {}\" has {} values; allowed: 3", p.type, p.name,
                            p.numbers.size()));
}

Spectrum spectrum_of(const std::vector<double>& numbers, const Place& place,
                     const std::string& of) {
  Spectrum out;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    if (!out.empty() && !(numbers[i] > out.back().first)) {
      fail(place, fmt::format("{}: wavelength {} after {}; allowed: growing ones", of, numbers[i],
                              out.back().first));
    }
    out.emplace_back(numbers[i], numbers[i + 1]);
  }
  if (numbers.size() % 2 == 0 && !out.empty()) return out;
  fail(place, fmt::format("{} has {} numbers; allowed: pairs of wavelength and value", of,
                          numbers.size()));
}

/// A file of pairs, with comments after #.
Spectrum spectrum_file(const Context& context, const std::string& name, const Place& place) {
  constexpr std::uint64_t max_bytes = 1 << 20;
  const auto path = context.resolve(name, place);
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) {
    fail(place, fmt::format("\"{}\" is neither a spectrum that is known by name nor a file", name));
  }
  const std::string text = read_unzipped(path, max_bytes);
  std::vector<double> numbers;
  bool comment = false;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '#') comment = true;
    if (c == '\n') comment = false;
    const auto is_space = [](char s) { return s == ' ' || s == '\t' || s == '\r' || s == '\n'; };
    if (comment || is_space(c)) {
      ++i;
      continue;
    }
    const auto end = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(i), text.end(),
                                  [&](char s) { return is_space(s) || s == '#'; });
    const std::string_view word(&text[i], static_cast<std::size_t>(end - text.begin()) - i);
    const auto number = number_of(word);
    if (!number) fail(place, fmt::format("{}: \"{}\" is no finite number", name, word));
    numbers.push_back(*number);
    i += word.size();
  }
  return spectrum_of(numbers, place, fmt::format("\"{}\"", name));
}

/// The numbers or the file of a spectrum.
Spectrum spectrum(const Context& context, const Parameter& p) {
  if (p.texts.empty()) {
    if (p.numbers.size() == 1) return {{300, p.numbers[0]}, {900, p.numbers[0]}};
    return spectrum_of(p.numbers, p.place, fmt::format("parameter \"{}\"", p.name));
  }
  return spectrum_file(context, p.texts[0], p.place);
}

/// CIE 1931 chromaticities of pbrt-v4's named illuminants (CIE 15: tables T.3 and T.8; ACES white).
struct Illuminant {
  std::string_view name;
  double x, y;
};
constexpr std::array<Illuminant, 16> illuminants{{{"stdillum-A", .44757, .40745},
                                                  {"stdillum-D50", .34567, .35850},
                                                  {"stdillum-D65", .31272, .32903},
                                                  {"stdillum-F1", .3131, .3371},
                                                  {"stdillum-F2", .3721, .3751},
                                                  {"stdillum-F3", .4091, .3941},
                                                  {"stdillum-F4", .4402, .4031},
                                                  {"stdillum-F5", .3138, .3452},
                                                  {"stdillum-F6", .3779, .3882},
                                                  {"stdillum-F7", .3129, .3292},
                                                  {"stdillum-F8", .3458, .3586},
                                                  {"stdillum-F9", .3741, .3727},
                                                  {"stdillum-F10", .3458, .3588},
                                                  {"stdillum-F11", .3805, .3769},
                                                  {"stdillum-F12", .4370, .4042},
                                                  {"illum-acesD60", .32168, .33767}}};

std::optional<Rgb> illuminant(const Parameter& p) {
  if (p.texts.size() != 1) return {};
  for (const Illuminant& i : illuminants) {
    if (i.name == p.texts[0]) return rgb_of_xyz({i.x / i.y, 1, (1 - i.x - i.y) / i.y});
  }
  return {};
}

Rgb positive(const Rgb& c) {
  return {std::max(c.x, 0.0F), std::max(c.y, 0.0F), std::max(c.z, 0.0F)};
}

double kelvin_of(const Parameter& p) {
  const double t = p.numbers.empty() ? 0 : p.numbers[0];
  if (t >= 100 && t <= 1e6) return t;
  fail(p.place, fmt::format("black body \"{}\" of {} K; allowed: 100 to 1e6", p.name, t));
}

/// The largest radiance per nm of a black body, by Wien's law, in the unit of blackbody_rgb().
double peak_of(double kelvin) {
  constexpr double c = 299792458, h = 6.62607015e-34, k = 1.380649e-23;
  constexpr double x = 4.965114231744276;  // x = 5 (1 - exp(-x)), x = hc / (wavelength k T)
  const double wavelength = h * c / (x * k * kelvin);
  return 2 * h * c * c / (std::pow(wavelength, 5) * std::expm1(x)) * 1e-9;
}

Rgb over_luminance(const Rgb& c, const Parameter& p) {
  const float y = luminance(c);
  if (y > 0) return positive(c / y);
  fail(p.place, fmt::format("light \"{}\" has no luminance", p.name));
}

/// Au of `metal-Au-eta`; empty if the text has another form.
std::string metal_name(const std::string& text) {
  const auto end = text.find_last_of('-');
  if (!text.starts_with("metal-") || end <= 6) return {};
  return text.substr(6, end - 6);
}

std::optional<MetalIndex> named_metal(const std::string& name) {
  // Not in Mitsuba's tables: brass (CuZn) and rutile (TiO2), at 640, 550 and 450 nm.
  if (name == "CuZn") return MetalIndex{{.444F, .527F, 1.094F}, {3.695F, 2.765F, 1.829F}};
  if (name == "TiO2") return MetalIndex{{2.585F, 2.648F, 2.809F}, {0, 0, 0}};
  return metal_index(name);
}

}  // namespace

Rgb reflected_colour(const Context& context, const Parameter& p) {
  if (p.type == "rgb") return from_space(context.colours, three(p));
  if (p.type == "xyz") return rgb_of_xyz(three(p));
  if (p.type == "blackbody") return emitted_colour(context, p);
  if (const auto named = illuminant(p)) return *named;
  return positive(rgb_of_spectrum(spectrum(context, p),
                                  context.is_v3() ? EqualEnergy::coloured : EqualEnergy::white));
}

Rgb emitted_colour(const Context& context, const Parameter& p) {
  if (p.type == "rgb") return positive(from_space(context.colours, three(p)));
  if (p.type == "xyz") return positive(rgb_of_xyz(three(p)));
  if (p.type == "blackbody") {
    const double kelvin = kelvin_of(p);
    const Rgb c = blackbody_rgb(kelvin);
    if (!context.is_v3()) return over_luminance(c, p);
    const double scale = p.numbers.size() > 1 ? p.numbers[1] : 1;
    return c * static_cast<float>(scale / peak_of(kelvin));
  }
  if (const auto named = illuminant(p)) return positive(*named);
  const Rgb c = rgb_of_spectrum(spectrum(context, p), EqualEnergy::coloured);
  return context.is_v3() ? positive(c) : over_luminance(c, p);
}

Rgb conductor_index(Context& context, const Parameters& parameters, const char* name,
                    bool imaginary) {
  const Parameter* p = parameters.find_spectrum(name);
  const std::string text = p != nullptr && !p->texts.empty() ? p->texts[0] : "";
  const std::string metal = p == nullptr ? "Cu" : metal_name(text);
  if (!metal.empty()) {
    const auto index = named_metal(metal);
    if (!index) fail(p->place, fmt::format("there is no named spectrum \"{}\"", text));
    if (!context.is_v3() && !imaginary) {
      context.approximated(parameters.place(), parameters.owner(),
                           fmt::format("the spectra of {} are three values each", metal));
    }
    return imaginary ? index->k : index->eta;
  }
  if (p->type == "rgb") return Rgb(V3f(three(*p)));  // no colour: of no colour space
  return positive(rgb_of_spectrum(spectrum(context, *p),
                                  context.is_v3() ? EqualEnergy::coloured : EqualEnergy::white));
}

double interface_index(Context& context, const Parameters& parameters, const char* name,
                       double otherwise) {
  if (const auto number = parameters.number(name)) return *number;
  if (const Parameter* texture = parameters.find(name, {"texture"})) {
    context.approximated(texture->place, parameters.owner(),
                         fmt::format("index of refraction {} instead of a texture", otherwise));
    return otherwise;
  }
  const Parameter* p = parameters.find_spectrum(name);
  if (p == nullptr) return otherwise;
  // At 587.6 nm, of Schott's catalogue; the names are those of pbrt-v4, which mean SF glasses.
  constexpr std::array<std::pair<std::string_view, double>, 7> glasses{{{"glass-BK7", 1.5168},
                                                                        {"glass-BAF10", 1.6700},
                                                                        {"glass-FK51A", 1.4866},
                                                                        {"glass-LASF9", 1.8503},
                                                                        {"glass-F5", 1.6727},
                                                                        {"glass-F10", 1.7283},
                                                                        {"glass-F11", 1.7847}}};
  double index = 0;
  for (const auto& [glass, value] : glasses) {
    if (!p->texts.empty() && p->texts[0] == glass) index = value;
  }
  if (index == 0 && (p->type == "rgb" || p->type == "xyz")) index = three(*p).y;
  if (index == 0) {
    const Spectrum s = spectrum(context, *p);
    const auto above =
        std::find_if(s.begin(), s.end(), [](const auto& v) { return v.first >= 589; });
    index = above == s.end() ? s.back().second : above->second;
    if (above != s.end() && above != s.begin()) {
      const auto& [l0, v0] = *(above - 1);
      index = v0 + (v0 == index ? 0 : (index - v0) * (589 - l0) / (above->first - l0));
    }
  }
  context.approximated(p->place, parameters.owner(),
                       fmt::format("no dispersion: index of refraction {:.4f}", index));
  return index;
}

ColourSpace colour_space(const std::string& name, const Place& place) {
  if (name == "srgb") return ColourSpace::srgb;
  if (name == "rec2020") return ColourSpace::rec2020;
  if (name == "dci-p3") return ColourSpace::dci_p3;
  if (name == "aces2065-1") return ColourSpace::aces;
  fail(place, fmt::format("ColorSpace \"{}\"; allowed: srgb, rec2020, dci-p3, aces2065-1", name));
}

}  // namespace lacuna::pbrt
