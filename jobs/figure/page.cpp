#include "jobs/figure/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "jobs/figure/surface.h"

namespace lacuna {

double FigurePage::width_of(const std::string& text, const TextStyle& style) const {
  return text_width(drawing.font, style, text);
}

TextStyle FigurePage::fitting(const std::vector<std::string>& texts, TextStyle style,
                              double most) const {
  double widest = most;
  for (const std::string& text : texts) widest = std::max(widest, width_of(text, style));
  constexpr double least = 4.5;
  style.size = std::max(least, style.size * most / widest);
  return style;
}

void FigurePage::text(TextMark mark, double most) {
  if (mark.text.empty()) return;
  mark.style = fitting({mark.text}, mark.style, most);
  drawing.add(std::move(mark));
}

Ink method_ink(std::size_t i) {
  constexpr std::array<Ink, 8> inks{{{0, 0.447, 0.698, 1},
                                     {0.835, 0.369, 0, 1},
                                     {0, 0.62, 0.451, 1},
                                     {0.8, 0.475, 0.655, 1},
                                     {0.902, 0.624, 0, 1},
                                     {0.337, 0.706, 0.914, 1},
                                     {0, 0, 0, 1},
                                     {0.6, 0.6, 0.6, 1}}};
  return inks[i % inks.size()];
}

Ink crop_ink(std::size_t i) {
  constexpr std::array<Ink, 4> inks{
      {{0.95, 0.25, 0.2, 1}, {0.2, 0.6, 0.95, 1}, {0.98, 0.75, 0.1, 1}, {0.3, 0.75, 0.35, 1}}};
  return inks[i % inks.size()];
}

std::string power_text(int exponent) {
  constexpr std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  if (exponent < 0) text += "⁻";
  for (const char c : std::to_string(std::abs(exponent))) {
    text += digits[static_cast<std::size_t>(c - '0')];
  }
  return text;
}

std::string figure_number(double value) {
  if (value == 0) return "0";
  const double size = std::abs(value);
  if (size >= 0.000995 && size < 99950) {
    const int digits = std::clamp(2 - static_cast<int>(std::floor(std::log10(size))), 0, 6);
    std::string text = fmt::format("{:.{}f}", value, digits);
    // Rounding may have added a digit: 9.996 is "10.0".
    if (digits > 0 && std::stod(text) >= std::pow(10, 3 - digits)) {
      text = fmt::format("{:.{}f}", value, digits - 1);
    }
    return text;
  }
  int exponent = static_cast<int>(std::floor(std::log10(size)));
  double mantissa = value / std::pow(10, exponent);
  if (std::abs(mantissa) >= 9.995) {
    mantissa /= 10;
    ++exponent;
  }
  return fmt::format("{:.2f} · {}", mantissa, power_text(exponent));
}

std::string figure_interval(const Estimate& estimate) {
  if (!estimate.interval) return "";
  return fmt::format("[{}, {}]", figure_number(estimate.interval->low),
                     figure_number(estimate.interval->high));
}

}  // namespace lacuna
