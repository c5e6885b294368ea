#include "jobs/figure/figure.h"

#include <fmt/format.h>

#include "base/storage/atomic_file.h"
#include "jobs/figure/figure_tex.h"
#include "jobs/figure/panels.h"
#include "jobs/figure/surface.h"

namespace lacuna {
namespace {

constexpr double points_per_mm = 72 / 25.4;

std::vector<RowPictures> read_rows(const FigureSource& source) {
  const double columns = source.spec().width / 25.4 * source.spec().dpi;
  std::vector<RowPictures> rows;
  for (std::size_t i = 0; i < source.rows().size(); ++i) {
    rows.push_back(read_row(source, i, columns));
  }
  return rows;
}

Drawing draw_panels(const FigureSource& source, const std::vector<FigurePanel>& panels,
                    const std::vector<RowPictures>& rows) {
  FigurePage page;
  page.drawing.width = source.spec().width * points_per_mm;
  page.drawing.font =
      source.spec().font == FigureFont::serif ? "Linux Libertine O" : "Linux Biolinum O";
  page.drawing.jpeg_quality = source.spec().lossless ? 0 : 95;
  page.drawing.title = source.sweep().spec().label;
  for (const FigurePanel panel : panels) {
    page.y += 2;
    switch (panel) {
      case FigurePanel::pictures:
        add_pictures(page, source, rows);
        break;
      case FigurePanel::convergence:
        add_convergence(page, source, rows);
        break;
      case FigurePanel::table:
        add_table(page, figure_table(source));
        break;
    }
  }
  page.drawing.height = page.y;
  return std::move(page.drawing);
}

}  // namespace

Drawing draw_figure(const FigureSource& source) {
  return draw_panels(source, source.spec().show, read_rows(source));
}

void write_figure(const FigureSource& source, const std::filesystem::path& file) {
  const std::string format = file.extension().string();
  if (format == ".csv") return write_file_atomically(file, table_csv(source));
  if (format == ".md") return write_file_atomically(file, table_markdown(figure_table(source)));
  if (format == ".tex") {
    const auto rows = read_rows(source);
    return write_tex(source, rows, draw_panels(source, {FigurePanel::convergence}, rows), file);
  }
  const Drawing drawing = draw_figure(source);
  write_file_atomically(file, format == ".png"   ? draw_png(drawing, source.spec().dpi)
                              : format == ".svg" ? draw_svg(drawing)
                                                 : draw_pdf(drawing));
}

}  // namespace lacuna
