#include <algorithm>

#include "jobs/figure/panels.h"

namespace lacuna {
namespace {

constexpr double line_step = 9.5;
constexpr TextStyle table_text{7, false, figure_black};
constexpr TextStyle table_head{7, true, figure_black};
constexpr TextStyle table_small{5.5, false, figure_grey};

void table_rule(FigurePage& page, double width) {
  page.drawing.add(LineMark{{{0, page.y}, {page.drawing.width, page.y}}, width, figure_black});
}

}  // namespace

void add_table(FigurePage& page, const FigureTable& table) {
  double scene_width = 0, quantity_width = 0;
  for (const auto& row : table.rows) {
    scene_width = std::max(scene_width, page.width_of(row.scene, table_head));
    quantity_width = std::max(quantity_width, page.width_of(row.quantity, table_text));
  }
  scene_width = std::min(scene_width, page.drawing.width / 6);
  quantity_width = std::min(quantity_width, page.drawing.width / 4);
  const double left = scene_width + 8 + quantity_width + 8;
  const double column = (page.drawing.width - left) /
                        static_cast<double>(std::max<std::size_t>(1, table.methods.size()));
  const auto right_of = [&](std::size_t m) { return left + static_cast<double>(m + 1) * column; };

  // Values end where intervals begin, so that both stand in columns.
  const double interval = std::min(0.52 * column, 58.0);
  const auto value_end = [&](std::size_t m) { return right_of(m) - interval; };

  table_rule(page, 0.8);
  page.y += line_step;
  for (std::size_t m = 0; m < table.methods.size(); ++m) {
    page.text({value_end(m), page.y - 1, table.methods[m], table_head, 1}, column - interval);
  }
  page.y += 2.5;
  table_rule(page, 0.4);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    const bool first = i == 0 || table.rows[i - 1].scene != row.scene;
    if (first && i > 0) page.y += 4;
    page.y += line_step;
    if (first) page.text({0, page.y, row.scene, table_head}, scene_width);
    page.text({scene_width + 8, page.y, row.quantity, table_text}, quantity_width);
    for (std::size_t m = 0; m < row.cells.size(); ++m) {
      const FigureTableCell& c = row.cells[m];
      const double end = value_end(m);
      page.text({end, page.y, c.value, c.best ? table_head : table_text, 1}, column - interval - 4);
      page.text({end + 3, page.y, c.interval, table_small}, interval - 3);
    }
  }
  page.y += 4;
  table_rule(page, 0.8);
  page.y += 7;
  page.text({0, page.y, table.note, table_small}, page.drawing.width);
  page.y += 8;
}

}  // namespace lacuna
