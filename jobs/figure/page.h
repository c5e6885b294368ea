#pragma once

#include <string>
#include <vector>

#include "jobs/figure/drawing.h"
#include "jobs/sweep/estimate.h"

namespace lacuna {

/// A drawing that grows downwards, and the letters and colours of all panels.
struct FigurePage {
  Drawing drawing;
  double y = 0;  ///< where the next panel begins

  /// Adds the text in fitting() style.
  void text(TextMark mark, double most = 1e9);
  /// The style, smaller if one of the texts is wider than `most`, but not below 4.5 points.
  TextStyle fitting(const std::vector<std::string>& texts, TextStyle style, double most) const;
  double width_of(const std::string& text, const TextStyle& style) const;
};

inline constexpr Ink figure_black{0, 0, 0, 1}, figure_grey{0.35, 0.35, 0.35, 1},
    figure_light{0.85, 0.85, 0.85, 1};

/// The colour of the i-th method: those of Okabe and Ito, which colour-blind people can tell apart.
Ink method_ink(std::size_t i);
/// The frame of the i-th crop.
Ink crop_ink(std::size_t i);

/// Three digits; powers of ten with superscripts: "1.23 · 10⁻⁵".
std::string figure_number(double value);
/// "[0.0121, 0.0135]", without text if there is no interval.
std::string figure_interval(const Estimate& estimate);
/// The power of ten of a tick: "10⁻³".
std::string power_text(int exponent);

}  // namespace lacuna
