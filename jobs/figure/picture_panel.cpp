#include <fmt/format.h>

#include <algorithm>

#include "jobs/figure/figure_table.h"
#include "jobs/figure/panels.h"
#include "renderer/film/error_map.h"

namespace lacuna {
namespace {

constexpr double gap = 2;      // between pictures, points
constexpr double row_gap = 9;  // between scenes
constexpr TextStyle name_style{7.5, true, figure_black};
constexpr TextStyle value_style{7, false, figure_black};
constexpr TextStyle small_style{5.5, false, figure_grey};

class RowPainter {
 public:
  RowPainter(FigurePage& page, const FigureSource& source, std::size_t index,
             const RowPictures& row)
      : page_(page),
        source_(source),
        index_(index),
        row_(row),
        size_(row_layout(row.shape, page.drawing.width, gap)) {}

  void run() {
    const double top = page_.y + 8;
    paint_whole(top);
    double x = size_.whole_width + 2 * gap;
    double below = top + size_.whole_height;
    std::vector<std::string> names;
    for (const FigureMethod& m : source_.spec().methods) names.push_back(m.name);
    if (row_.details.size() > methods()) names.emplace_back("Reference");
    const TextStyle style = page_.fitting(names, name_style, size_.detail_width);
    for (std::size_t column = 0; column < names.size(); ++column) {
      page_.text({x + size_.detail_width / 2, top - 3, names[column], style, 0.5});
      paint_column(x, top, column);
      x += size_.detail_width + gap;
    }
    below = paint_numbers(below);
    below = std::max(below, paint_caption(top + size_.whole_height));
    page_.y = below + row_gap;
  }

 private:
  std::size_t methods() const { return source_.spec().methods.size(); }

  void paint_whole(double top) {
    page_.drawing.add(ImageMark{0, top, size_.whole_width, size_.whole_height, row_.whole});
    const double scale = size_.whole_width / source_.rows()[index_].resolution[0];
    if (source_.spec().scenes[index_].crops.empty()) return;
    for (std::size_t i = 0; i < row_.crops.size(); ++i) {
      const PixelRect& c = row_.crops[i];
      constexpr double line = 1;
      const double x = c.x * scale + line / 2, y = top + c.y * scale + line / 2,
                   w = c.width * scale - line, h = c.height * scale - line;
      page_.drawing.add(
          LineMark{{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}, {x, y}}, line, crop_ink(i)});
    }
  }

  double paint_caption(double y) {
    y += 8;
    const FigureScene& scene = source_.spec().scenes[index_];
    page_.text({0, y, scene.name, name_style}, size_.whole_width);
    y += 7;
    const std::string tone = source_.spec().tone == ToneCurve::filmic ? "filmic (ACES)" : "sRGB";
    std::string text = fmt::format("{:+.2f} stops, {}", row_.exposure, tone);
    if (row_.whole_of != "reference") text = fmt::format("{}; {}", row_.whole_of, text);
    page_.text({0, y, text, small_style}, size_.whole_width);
    return y;
  }

  void paint_column(double x, double top, std::size_t column) {
    const bool is_reference = column == methods();
    double y = top;
    for (std::size_t i = 0; i < row_.crops.size(); ++i) {
      if (row_.details[column].empty()) {
        missing(x, y, size_.detail_height);
      } else {
        const bool framed = !source_.spec().scenes[index_].crops.empty();
        // The frame lies inside of the picture's place.
        constexpr double frame = 1;
        const double inset = framed ? frame / 2 : 0;
        page_.drawing.add(ImageMark{x + inset, y + inset, size_.detail_width - 2 * inset,
                                    size_.detail_height - 2 * inset, row_.details[column][i],
                                    framed ? frame : 0, crop_ink(i)});
      }
      y += size_.detail_height + gap;
    }
    if (row_.error_maps.empty()) return;
    if (is_reference) {
      paint_scale(x, y);
    } else if (row_.error_maps[column].width > 0) {
      page_.drawing.add(
          ImageMark{x, y, size_.detail_width, size_.map_height, row_.error_maps[column]});
    } else {
      missing(x, y, size_.map_height);
    }
  }

  void missing(double x, double y, double height) {
    const double right = x + size_.detail_width, bottom = y + height;
    page_.drawing.add(AreaMark{{{x, y}, {right, y}, {right, bottom}, {x, bottom}}, figure_light});
    page_.text({(x + right) / 2, (y + bottom) / 2 + 2, "not rendered", small_style, 0.5},
               size_.detail_width);
  }

  /// The colours of the error maps, beside them.
  void paint_scale(double x, double y) {
    CodeImage colours{1, 64, {}};
    for (int i = 0; i < colours.height; ++i) {
      const auto c = magma(1 - (i + 0.5) / colours.height);
      colours.rgb.insert(colours.rgb.end(), c.begin(), c.end());
    }
    const double height = size_.map_height - 2;
    page_.drawing.add(ImageMark{x, y + 1, 5, height, std::move(colours)});
    const TextStyle style{5.5, false, figure_black};
    const double most = size_.detail_width - 8;
    const bool bounded = source_.spec().error_map == ErrorMetric::flip;
    page_.text({x + 8, y + 5,
                (bounded ? "" : "≥ ") + (bounded ? "1" : figure_number(row_.largest_error)), style},
               most);
    page_.text({x + 8,
                y + height / 2 + 3,
                std::string(row_of(*source_.spec().error_map).label),
                {5.5, true, figure_black}},
               most);
    page_.text({x + 8, y + height + 1, "0", style}, most);
  }

  /// A line of text below each method, in one size; `bold`: a column.
  void paint_line(double y, const std::vector<std::string>& texts, const TextStyle& style,
                  std::optional<std::size_t> bold = {}) {
    TextStyle largest = style;
    largest.bold = bold.has_value();
    const double size = page_.fitting(texts, largest, size_.detail_width).size;
    double x = size_.whole_width + 2 * gap + size_.detail_width / 2;
    for (std::size_t column = 0; column < texts.size(); ++column) {
      page_.text({x, y, texts[column], {size, bold == column, style.ink}, 0.5});
      x += size_.detail_width + gap;
    }
  }

  /// Errors with intervals, and the time; the base line of the last.
  double paint_numbers(double y) {
    for (std::size_t k = 0; k < source_.metrics().size(); ++k) {
      std::vector<std::string> values(methods()), intervals(methods());
      for (std::size_t m = 0; m < methods(); ++m) {
        const ErrorAtTime* at = source_.error(index_, m, k);
        if (at == nullptr || !at->error) continue;
        values[m] = fmt::format("{} {}", row_of(source_.metrics()[k]).label, error_text(*at));
        intervals[m] = figure_interval(*at->error);
      }
      paint_line(y += 8, values, value_style, source_.best_error(index_, k));
      const bool any = std::any_of(intervals.begin(), intervals.end(),
                                   [](const std::string& text) { return !text.empty(); });
      if (any) paint_line(y += 6.5, intervals, small_style);
    }
    std::vector<std::string> times(methods());
    const bool wall = source_.answers().axes.clock == "seconds";
    for (std::size_t m = 0; m < methods(); ++m) {
      const ErrorAtTime* at = source_.error(index_, m, 0);
      if (at == nullptr) continue;
      times[m] = fmt::format("{} {}", figure_number(at->time), wall ? "s" : "CPU s");
    }
    paint_line(y += 8, times, value_style);
    return y;
  }

  FigurePage& page_;
  const FigureSource& source_;
  std::size_t index_;
  const RowPictures& row_;
  RowLayout size_;
};

}  // namespace

void add_pictures(FigurePage& page, const FigureSource& source,
                  const std::vector<RowPictures>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) RowPainter(page, source, i, rows[i]).run();
}

}  // namespace lacuna
