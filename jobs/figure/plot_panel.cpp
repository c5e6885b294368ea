#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "jobs/figure/log_axis.h"
#include "jobs/figure/panels.h"

namespace lacuna {
namespace {

constexpr TextStyle plot_title{7.5, true, figure_black};
constexpr TextStyle tick_style{6, false, figure_black};
constexpr TextStyle axis_style{6.5, false, figure_black};
constexpr Ink plot_grid{0.9, 0.9, 0.9, 1};
constexpr double margin_left = 34, margin_bottom = 23, margin_top = 13, margin_right = 6;

/// The plot of one scene.
class Plot {
 public:
  Plot(FigurePage& page, const FigureSource& source, std::size_t row,
       std::optional<double> reference_mse)
      : page_(page), source_(source), row_(row), noise_(noise_of(reference_mse)) {}

  /// `x`, `y`: the upper left of the plot with its labels.
  void paint(double x, double y, double width, double height) {
    find_range();
    const double left = x + margin_left, right = x + width - margin_right, top = y + margin_top,
                 bottom = y + height - margin_bottom;
    page_.text({(left + right) / 2, y + 8, source_.spec().scenes[row_].name, plot_title, 0.5},
               width);
    if (!(times_[1] > times_[0])) {
      page_.text({(left + right) / 2, (top + bottom) / 2, "no curve", axis_style, 0.5}, width);
      return;
    }
    across_ = {times_[0], times_[1], left, right};
    up_ = {errors_[0], errors_[1], bottom, top};
    paint_axes();
    paint_slope();
    paint_noise();
    for (std::size_t m = 0; m < source_.spec().methods.size(); ++m) paint_band(m);
    for (std::size_t m = 0; m < source_.spec().methods.size(); ++m) paint_mean(m);
    page_.drawing.add(LineMark{{{left, top}, {left, bottom}, {right, bottom}}, 0.6, figure_black});
  }

  /// Whether a curve reaches the reference's noise, which is drawn with dashes.
  bool has_floor() const {
    bool floor = false;
    each_point([&](const BandPoint& p) { floor = floor || p.at_floor; });
    return floor;
  }

 private:
  const std::vector<BandPoint>* curve_of(std::size_t method) const {
    const CellAnswer* cell = source_.cell(row_, method);
    return cell == nullptr || cell->curve.empty() ? nullptr : &cell->curve;
  }

  template <class Act>
  void each_point(const Act& act) const {
    for (std::size_t m = 0; m < source_.spec().methods.size(); ++m) {
      const auto* curve = curve_of(m);
      if (curve != nullptr) std::ranges::for_each(*curve, act);
    }
  }

  /// The error of the reference itself by the figure's metric, where its definition gives one.
  std::optional<double> noise_of(std::optional<double> mse) const {
    const ErrorMetric metric = source_.metrics().front();
    if (!mse || !(*mse > 0)) return {};
    if (metric == ErrorMetric::mse) return *mse;
    if (metric == ErrorMetric::rmse) return std::sqrt(*mse);
    return {};
  }

  void find_range() {
    const auto take = [](std::array<double, 2>& range, double v) {
      range = {std::min(range[0], v), std::max(range[1], v)};
    };
    each_point([&](const BandPoint& p) {
      take(times_, p.time);
      take(errors_, p.error.value);
      // A band that spans more than a decade does not set the scale alone.
      if (!p.error.interval) return;
      take(errors_, std::max(p.error.interval->low, p.error.value / 3));
      take(errors_, std::min(p.error.interval->high, p.error.value * 3));
    });
    if (noise_ && *noise_ > errors_[0] / 10) take(errors_, *noise_);
    errors_[0] /= 1.12;
    errors_[1] *= 1.12;
  }

  FigurePoint at(double time, double error) const {
    return {across_.at(time), up_.at(std::clamp(error, errors_[0], errors_[1]))};
  }

  void paint_axes() {
    for (const AxisTick& t : log_ticks(across_, 20)) {
      const double x = across_.at(t.value);
      const bool big = !t.label.empty();
      if (big) page_.drawing.add(LineMark{{{x, up_.from}, {x, up_.to}}, 0.4, plot_grid});
      page_.drawing.add(LineMark{{{x, up_.from}, {x, up_.from + (big ? 3 : 1.5)}}, 0.5});
      page_.text({x, up_.from + 9, t.label, tick_style, 0.5});
    }
    double widest = 0;
    for (const AxisTick& t : log_ticks(up_, 9)) {
      widest = std::max(widest, page_.width_of(t.label, tick_style));
      const double y = up_.at(t.value);
      const bool big = !t.label.empty();
      if (big) page_.drawing.add(LineMark{{{across_.from, y}, {across_.to, y}}, 0.4, plot_grid});
      page_.drawing.add(LineMark{{{across_.from - (big ? 3 : 1.5), y}, {across_.from, y}}, 0.5});
      page_.text({across_.from - 4, y + 2, t.label, tick_style, 1}, margin_left - 14);
    }
    const bool wall = source_.answers().axes.clock == "seconds";
    page_.text({(across_.from + across_.to) / 2, up_.from + 18,
                wall ? "render time (s)" : "CPU time / threads (s)", axis_style, 0.5});
    const ErrorMetricRow& metric = lacuna::row_of(source_.metrics().front());
    const std::string title = metric.unit.empty()
                                  ? std::string(metric.label)
                                  : fmt::format("{} ({})", metric.label, metric.unit);
    page_.text({across_.from - 9 - std::min(widest, margin_left - 14), (up_.from + up_.to) / 2,
                title, axis_style, 0.5, true},
               up_.from - up_.to);
  }

  /// The slope of independent samples, through the mean of all points (in logarithms).
  void paint_slope() {
    const double slope = lacuna::row_of(source_.metrics().front()).squared ? -1 : -0.5;
    double offset = 0;
    int points = 0;
    each_point([&](const BandPoint& p) {
      if (p.at_floor) return;
      offset += std::log(p.error.value) - slope * std::log(p.time);
      ++points;
    });
    if (points < 2 || source_.metrics().front() == ErrorMetric::flip) return;
    const auto error = [&](double t) { return std::exp(offset / points + slope * std::log(t)); };
    const auto time = [&](double e) { return std::exp((std::log(e) - offset / points) / slope); };
    const double from = std::max(times_[0], time(errors_[1])),
                 to = std::min(times_[1], time(errors_[0]));
    if (!(to > from)) return;
    page_.drawing.add(
        LineMark{{at(from, error(from)), at(to, error(to))}, 0.6, figure_grey, {1, 2}});
  }

  void paint_noise() {
    if (!noise_ || *noise_ < errors_[0]) return;
    const double y = up_.at(*noise_);
    page_.drawing.add(LineMark{{{across_.from, y}, {across_.to, y}}, 0.5, figure_grey, {4, 2}});
    page_.text({across_.to - 2, y - 2, "noise of the reference", {5.5, false, figure_grey}, 1});
  }

  void paint_band(std::size_t method) {
    const auto* curve = curve_of(method);
    if (curve == nullptr) return;
    std::vector<FigurePoint> corners;
    for (const BandPoint& p : *curve) {
      if (p.error.interval) corners.push_back(at(p.time, p.error.interval->high));
    }
    for (auto p = curve->rbegin(); p != curve->rend(); ++p) {
      if (p->error.interval) corners.push_back(at(p->time, p->error.interval->low));
    }
    Ink ink = method_ink(method);
    ink.alpha = 0.18;
    if (corners.size() > 2) page_.drawing.add(AreaMark{std::move(corners), ink});
  }

  /// The mean, with dashes where most of what is measured is the reference's noise.
  void paint_mean(std::size_t method) {
    const auto* curve = curve_of(method);
    if (curve == nullptr) return;
    LineMark line{{}, 1.1, method_ink(method)};
    bool floor = false;
    for (const BandPoint& p : *curve) {
      const FigurePoint here = at(p.time, p.error.value);
      line.points.push_back(here);
      if (p.at_floor == floor) continue;
      floor = p.at_floor;
      page_.drawing.add(line);
      line.points = {here};
      line.dashes = floor ? std::vector<double>{1.5, 1.5} : std::vector<double>{};
    }
    if (line.points.size() > 1) page_.drawing.add(std::move(line));
  }

  FigurePage& page_;
  const FigureSource& source_;
  std::size_t row_;
  std::optional<double> noise_;
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 2> times_{infinity, 0}, errors_{infinity, 0};
  LogAxis across_{}, up_{};
};

/// A line of the legend: a sample and its text.
struct LegendEntry {
  LineMark line;
  std::string text;
};

void add_legend(FigurePage& page, const std::vector<LegendEntry>& entries) {
  constexpr TextStyle style{6.5, false, figure_black};
  constexpr double sample = 14, space = 3, apart = 12;
  std::vector<double> widths;
  for (const LegendEntry& e : entries) {
    widths.push_back(sample + space + page.width_of(e.text, style) + apart);
  }
  std::size_t i = 0;
  while (i < entries.size()) {
    // As many as fit into a line, which is centred.
    std::size_t end = i;
    double width = -apart;
    while (end < entries.size() && (end == i || width + widths[end] <= page.drawing.width)) {
      width += widths[end++];
    }
    double x = (page.drawing.width - width) / 2;
    page.y += 9;
    for (; i < end; ++i) {
      LineMark line = entries[i].line;
      line.points = {{x, page.y - 2}, {x + sample, page.y - 2}};
      page.drawing.add(std::move(line));
      page.text({x + sample + space, page.y, entries[i].text, style});
      x += widths[i];
    }
  }
  page.y += 6;
}

}  // namespace

void add_convergence(FigurePage& page, const FigureSource& source,
                     const std::vector<RowPictures>& rows) {
  const std::size_t plots = source.rows().size();
  const auto fitting =
      static_cast<std::size_t>(std::clamp(std::floor(page.drawing.width / 150), 1.0, 4.0));
  const std::size_t lines = (plots + fitting - 1) / fitting;
  const std::size_t columns = (plots + lines - 1) / lines;
  const double gap = 8;
  const double width =
      (page.drawing.width - gap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
  const double height = std::clamp(0.72 * width, 90.0, 165.0);
  bool floor = false;
  for (std::size_t i = 0; i < plots; ++i) {
    Plot plot(page, source, i, rows[i].reference_mse);
    floor = floor || plot.has_floor();
    const auto column = static_cast<double>(i % columns), line = static_cast<double>(i / columns);
    plot.paint(column * (width + gap), page.y + line * height, width, height);
  }
  page.y += static_cast<double>(lines) * height;
  std::vector<LegendEntry> legend;
  for (std::size_t m = 0; m < source.spec().methods.size(); ++m) {
    legend.push_back({{{}, 1.1, method_ink(m)}, source.spec().methods[m].name});
  }
  const ErrorMetricRow& metric = lacuna::row_of(source.metrics().front());
  if (metric.value != ErrorMetric::flip) {
    legend.push_back({{{}, 0.6, figure_grey, {1, 2}}, metric.squared ? "slope −1" : "slope −1/2"});
  }
  if (floor) {
    legend.push_back({{{}, 1.1, figure_grey, {1.5, 1.5}}, "mostly noise of the reference"});
  }
  add_legend(page, legend);
  page.y += 6;
}

}  // namespace lacuna
