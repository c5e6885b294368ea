#pragma once

#include <optional>
#include <vector>

#include "jobs/figure/drawing.h"
#include "jobs/figure/figure_source.h"
#include "jobs/figure/row_layout.h"
#include "renderer/film/crop.h"

namespace lacuna {

/// The pixels of a scene of a figure: a column for each method, then the reference.
struct RowPictures {
  RowShape shape;
  CodeImage whole;                              ///< the reference, or the first picture
  std::string whole_of;                         ///< "reference", or a method's name
  double exposure = 0;                          ///< stops
  std::vector<PixelRect> crops;                 ///< at least one
  std::vector<std::vector<CodeImage>> details;  ///< by column and crop; empty: no picture
  std::vector<CodeImage> error_maps;            ///< by method; empty: none
  double largest_error = 1;                     ///< the brightest colour of the maps
  std::optional<double> reference_mse;          ///< the reference's own noise, if known
};

/// Reads the pictures of a row, one at a time: of each cell that of its first finished run, as in
/// the report. `page_width`: of the figure, in pixels; pictures that are larger than their place in
/// it are averages of displayed values. Throws SceneError, InputUnreadable.
RowPictures read_row(const FigureSource& source, std::size_t row, double page_width);

}  // namespace lacuna
