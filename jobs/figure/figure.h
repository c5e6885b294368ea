#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "jobs/figure/drawing.h"
#include "jobs/figure/figure_source.h"

namespace lacuna {

/// The drawing of a figure: the parts of `show` from top to bottom. Throws as read_row().
Drawing draw_figure(const FigureSource& source);

/// The formats of write_figure(): file name endings.
inline constexpr std::array<std::string_view, 6> figure_formats{".pdf", ".svg", ".png",
                                                                ".tex", ".csv", ".md"};

/// Writes the figure in the format of the file's ending: the drawing, for .csv and .md the table,
/// for .tex a LaTeX file with the text and the table, and beside it the folder NAME-pieces with the
/// pictures (PNG) and the curves (PDF). Throws std::system_error, std::runtime_error, and as
/// draw_figure().
void write_figure(const FigureSource& source, const std::filesystem::path& file);

}  // namespace lacuna
