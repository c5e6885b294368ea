#pragma once

#include <string>
#include <string_view>

#include "jobs/figure/drawing.h"

namespace lacuna {

/// The width of a line of text, in points.
double text_width(const std::string& font, const TextStyle& style, std::string_view text);

/// The drawing as a PDF of one page, with its fonts embedded; as an SVG, with its letters as
/// outlines; as a PNG of `dpi`. Pictures keep their own pixels. Throws std::runtime_error.
std::string draw_pdf(const Drawing& drawing);
std::string draw_svg(const Drawing& drawing);
std::string draw_png(const Drawing& drawing, int dpi);

}  // namespace lacuna
