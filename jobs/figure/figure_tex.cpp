#include "jobs/figure/figure_tex.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/storage/atomic_file.h"
#include "jobs/figure/surface.h"
#include "renderer/images/png_write.h"

namespace lacuna {
namespace {

class TexWriter {
 public:
  TexWriter(const FigureSource& source, const std::vector<RowPictures>& rows, const Drawing& curves,
            const std::filesystem::path& file)
      : source_(source),
        rows_(rows),
        curves_(curves),
        file_(file),
        folder_(fmt::format("{}-pieces", file.stem().string())) {}

  void run() {
    std::filesystem::create_directories(file_.parent_path() / folder_);
    text_ = "% Needs \\usepackage{booktabs,graphicx}.\n";
    for (const FigurePanel panel : source_.spec().show) {
      switch (panel) {
        case FigurePanel::pictures:
          for (std::size_t i = 0; i < rows_.size(); ++i) put_row(i);
          break;
        case FigurePanel::convergence:
          put_curves();
          break;
        case FigurePanel::table:
          text_ += "\n\\begin{table*}\n\\centering\\small\n" + table_latex(figure_table(source_)) +
                   "\\end{table*}\n";
          break;
      }
    }
    write_file_atomically(file_, text_);
  }

 private:
  /// Writes a piece; the command that shows it `width` (of the line) wide.
  std::string piece(const std::string& name, const CodeImage& image, double width) {
    if (image.width == 0) return "";
    const std::string path = fmt::format("{}/{}.png", folder_, name);
    write_file_atomically(file_.parent_path() / path,
                          encode_png(image.width, image.height, image.rgb));
    return fmt::format("\\includegraphics[width={:.4f}\\linewidth]{{{}}}", width, path);
  }

  void put_row(std::size_t r) {
    const RowPictures& row = rows_[r];
    const FigureScene& scene = source_.spec().scenes[r];
    const std::size_t methods = source_.spec().methods.size(), columns = row.details.size();
    const double width = std::min(0.24, 0.96 / static_cast<double>(columns));  // fits a page
    text_ += fmt::format("\n\\begin{{figure*}}\n\\centering\n{}\n\n",
                         piece(fmt::format("{}-whole", r + 1), row.whole, 0.5));
    text_ += fmt::format("\\setlength{{\\tabcolsep}}{{1pt}}\n\\begin{{tabular}}{{{}}}\n",
                         std::string(columns, 'c'));
    for (std::size_t c = 0; c < columns; ++c) {
      text_ += fmt::format("{}{}", c > 0 ? " & " : "",
                           c < methods ? latex_text(source_.spec().methods[c].name) : "Reference");
    }
    text_ += " \\\\\n";
    for (std::size_t k = 0; k < row.crops.size(); ++k) {
      put_line(columns, [&](std::size_t c) {
        return row.details[c].empty() ? std::string()
                                      : piece(fmt::format("{}-{}-crop{}", r + 1, c + 1, k + 1),
                                              row.details[c][k], width);
      });
    }
    if (!row.error_maps.empty()) {
      put_line(methods, [&](std::size_t c) {
        return piece(fmt::format("{}-{}-error", r + 1, c + 1), row.error_maps[c], width);
      });
    }
    for (std::size_t k = 0; k < source_.metrics().size(); ++k) {
      put_line(methods, [&](std::size_t c) { return number(r, c, k); });
    }
    text_ +=
        fmt::format("\\end{{tabular}}\n\\caption{{{}: {:+.2f} stops, {}.}}\n\\end{{figure*}}\n",
                    latex_text(scene.name), row.exposure,
                    source_.spec().tone == ToneCurve::filmic ? "filmic (ACES)" : "sRGB");
  }

  template <class Part>
  void put_line(std::size_t columns, const Part& part) {
    for (std::size_t c = 0; c < columns; ++c) text_ += (c > 0 ? " & " : "") + part(c);
    text_ += " \\\\\n";
  }

  std::string number(std::size_t row, std::size_t method, std::size_t metric) const {
    const ErrorAtTime* at = source_.error(row, method, metric);
    if (at == nullptr || !at->error) return "";
    const std::string text = latex_text(
        fmt::format("{} {}", lacuna::row_of(source_.metrics()[metric]).label, error_text(*at)));
    const bool best = source_.best_error(row, metric) == method;
    return best ? fmt::format("\\textbf{{{}}}", text) : text;
  }

  void put_curves() {
    const std::string path = fmt::format("{}/convergence.pdf", folder_);
    write_file_atomically(file_.parent_path() / path, draw_pdf(curves_));
    text_ += fmt::format(
        "\n\\begin{{figure*}}\n\\centering\n\\includegraphics[width=\\linewidth]{{{}}}\n"
        "\\end{{figure*}}\n",
        path);
  }

  const FigureSource& source_;
  const std::vector<RowPictures>& rows_;
  const Drawing& curves_;
  std::filesystem::path file_;
  std::string folder_, text_;
};

}  // namespace

void write_tex(const FigureSource& source, const std::vector<RowPictures>& rows,
               const Drawing& curves, const std::filesystem::path& file) {
  TexWriter(source, rows, curves, file).run();
}

}  // namespace lacuna
