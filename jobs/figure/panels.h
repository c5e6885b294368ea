#pragma once

#include <vector>

#include "jobs/figure/figure_table.h"
#include "jobs/figure/page.h"
#include "jobs/figure/row_pictures.h"

namespace lacuna {

// Each function draws a panel from page.y on, as wide as the page, and moves page.y below it.

/// For each scene the whole picture with its crops marked, and a column for each method and the
/// reference: the crops at one exposure, errors with intervals, and the render time.
void add_pictures(FigurePage& page, const FigureSource& source,
                  const std::vector<RowPictures>& rows);

/// For each scene the mean error of each method over time, with bands.
void add_convergence(FigurePage& page, const FigureSource& source,
                     const std::vector<RowPictures>& rows);

/// The table, with rules above, below and under its head.
void add_table(FigurePage& page, const FigureTable& table);

}  // namespace lacuna
