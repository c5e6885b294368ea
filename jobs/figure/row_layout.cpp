#include "jobs/figure/row_layout.h"

namespace lacuna {

RowLayout row_layout(const RowShape& shape, double page_width, double gap) {
  const double whole = double(shape.whole[0]) / shape.whole[1];
  const double detail = double(shape.detail[0]) / shape.detail[1];
  const auto columns = static_cast<double>(shape.columns);
  const auto crops = static_cast<double>(shape.crops);
  // With the height h of a detail: its width is detail * h, a map's height that over `whole`, and
  // the whole picture is crops * h, the map and the gaps high.
  const double per_h = crops + (shape.mapped ? detail / whole : 0);
  const double gaps = gap * (crops - (shape.mapped ? 0 : 1));
  const double h = (page_width - 2 * gap - (columns - 1) * gap - whole * gaps) /
                   (whole * per_h + columns * detail);
  const double height = per_h * h + gaps;
  return {whole * height, height, detail * h, h, shape.mapped ? detail * h / whole : 0};
}

}  // namespace lacuna
