#pragma once

#include <filesystem>
#include <vector>

#include "jobs/figure/panels.h"

namespace lacuna {

/// Writes the LaTeX file of a figure and its pieces, as write_figure(). `curves`: the drawing of
/// the convergence.
void write_tex(const FigureSource& source, const std::vector<RowPictures>& rows,
               const Drawing& curves, const std::filesystem::path& file);

}  // namespace lacuna
