#include "renderer/images/texture_means.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna {

namespace {

/// The first level of sums. A lower level would have at least a fourth of the number of texels; the
/// texels are read instead.
constexpr int first_shift = 2;

int cells_along(int size, int shift) { return (size + (1 << shift) - 1) >> shift; }

/// One axis of a texture, divided into cells.
struct Axis {
  int size;  // texels
  Texture::Wrap wrap;
  int shift;  // cells have 2^shift texels

  /// Calls `f(cell, from, to)` for each cell that overlaps the interval [low, high] of unwrapped
  /// texel coordinates, with the overlap.
  template <class F>
  void for_each_cell(double low, double high, F&& f) const {
    if (wrap == Texture::Wrap::clamp) {
      cells_between(low, high, true, f);
      return;
    }
    for (double k = std::floor(low / size); k * size < high; ++k) {
      const double begin = k * size;
      const double from = std::max(low - begin, 0.0), to = std::min(high - begin, double(size));
      if (wrap == Texture::Wrap::mirrored && std::fmod(k, 2) != 0) {
        cells_between(size - to, size - from, false, [&](int cell, double a, double b) {
          f(cell, begin + size - b, begin + size - a);
        });
      } else {
        cells_between(from, to, false,
                      [&](int cell, double a, double b) { f(cell, begin + a, begin + b); });
      }
    }
  }

 private:
  /// `endless`: the first and the last cell extend to infinity.
  template <class F>
  void cells_between(double low, double high, bool endless, F&& f) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const int last = cells_along(size, shift) - 1;
    const auto cell_of = [&](double x) {
      return std::min(static_cast<int>(std::clamp(x, 0.0, double(size))) >> shift, last);
    };
    for (int cell = cell_of(low); cell <= cell_of(high); ++cell) {
      const double begin = cell == 0 && endless ? -infinity : double(cell << shift);
      const double end = cell == last && endless ? infinity : double((cell + 1) << shift);
      const double from = std::max(low, begin), to = std::min(high, end);
      if (from < to) f(cell, from, to);
    }
  }
};

/// An interval of coordinates; empty at first.
struct Interval {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  /// Its length on the texture, clipped if the texture does not repeat.
  double length_on(int size, Texture::Wrap wrap) const {
    if (wrap != Texture::Wrap::clamp) return high - low;
    return std::clamp(high, 0.0, double(size)) - std::clamp(low, 0.0, double(size));
  }
};

using Corners = std::array<Imath::V2d, 3>;

/// The x interval of the part of a triangle with y in [low, high].
Interval across(const Corners& corners, double low, double high) {
  Interval x;
  for (std::size_t k = 0; k < 3; ++k) {
    const Imath::V2d &a = corners[k], &b = corners[(k + 1) % 3];
    if (a.y >= low && a.y <= high) x.add(a.x);
    for (const double y : {low, high}) {
      if ((a.y < y) == (b.y < y)) continue;
      x.add(a.x + (b.x - a.x) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0));
    }
  }
  return x;
}

}  // namespace

TextureMeans::TextureMeans(const Texture& texture) : texture_(&texture) {
  const V2i size = texture.size();
  const auto new_level = [&](int shift) -> Level& {
    const int width = cells_along(size.x, shift), height = cells_along(size.y, shift);
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return levels_.emplace_back(Level{shift, width, height, std::vector<Rgb>(count, Rgb(0, 0, 0))});
  };
  const auto row = [](Level& level, int y) {
    return level.sums.begin() + static_cast<std::ptrdiff_t>(y) * level.width;
  };
  Level& first = new_level(first_shift);
  for (int y = 0; y < size.y; ++y) {
    const auto sums = row(first, y >> first_shift);
    for (int x = 0; x < size.x; ++x) sums[x >> first_shift] += texture.texel({x, y});
  }
  while (levels_.back().sums.size() > 1) {
    Level& coarse = new_level(levels_.back().shift + 1);
    Level& fine = *(levels_.end() - 2);
    for (int y = 0; y < fine.height; ++y) {
      const auto from = row(fine, y), to = row(coarse, y / 2);
      for (int x = 0; x < fine.width; ++x) to[x / 2] += from[x];
    }
  }
}

V3d TextureMeans::mean(const Level* level, Cell cell) const {
  if (level == nullptr) return V3d(texture_->texel({cell.x, cell.y}));
  const V2i size = texture_->size();
  const auto side = [&](int at, int all) {
    return double(std::min(1 << level->shift, all - (at << level->shift)));
  };
  const auto index = static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(level->width) +
                     static_cast<std::size_t>(cell.x);
  return V3d(level->sums[index]) / (side(cell.x, size.x) * side(cell.y, size.y));
}

V3d TextureMeans::whole() const { return mean(&levels_.back(), {0, 0}); }

TextureMeans::Mean TextureMeans::over(const std::array<V2f, 3>& uv, float largest) const {
  const V2i size = texture_->size();
  // A lookup reads the texels whose centres are within 1 of it in both axes, so they cover the
  // triangle widened by a half on all sides, and by the rounding error of coordinates, a few times
  // 2^-24.
  constexpr double few_roundings = 0x1p-20;
  const double margin = 0.5 + few_roundings * double(largest) * std::max(size.x, size.y);
  Corners corners;
  Interval x, y;
  for (std::size_t k = 0; k < 3; ++k) {
    corners[k] = {double(uv[k].x) * size.x, double(uv[k].y) * size.y};
    x.add(corners[k].x);
    y.add(corners[k].y);
  }
  const bool placed = std::all_of(
      uv.begin(), uv.end(), [](const V2f& c) { return std::isfinite(c.x) && std::isfinite(c.y); });
  if (!placed || !(margin <= std::min(size.x, size.y))) return {whole(), 1};

  const double width = x.length_on(size.x, texture_->wrap_s()) + 2 * margin;
  const double height = y.length_on(size.y, texture_->wrap_t()) + 2 * margin;
  const Imath::V2d e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const double area = std::min(std::abs(e1.x * e2.y - e1.y * e2.x) / 2, width * height);
  // A bound on the number of cells, a by b texels on average, that the widened triangle overlaps:
  // its area; the horizontal extents of the two edges in each row, on each side at most the width
  // over all rows; and in each row the margins and the cells at both ends.
  const auto cells = [&](int shift) {
    const double a = double(size.x) / cells_along(size.x, shift);
    const double b = double(size.y) / cells_along(size.y, shift);
    return area / (a * b) + 2 * (width / a) * (1 + 2 * margin / b) +
           (height / b + 2) * (2 * margin / a + 2);
  };
  const Level* level = nullptr;
  if (cells(0) > most_cells) {
    const auto found = std::find_if(levels_.begin(), levels_.end(),
                                    [&](const Level& l) { return cells(l.shift) <= most_cells; });
    if (found == levels_.end()) return {whole(), 1};
    level = &*found;
  }

  const int shift = level == nullptr ? 0 : level->shift;
  const Axis along_x{size.x, texture_->wrap_s(), shift}, along_y{size.y, texture_->wrap_t(), shift};
  Mean result;
  double weights = 0;
  along_y.for_each_cell(y.low - margin, y.high + margin, [&](int j, double top, double bottom) {
    const Interval row = across(corners, top - margin, bottom + margin);
    along_x.for_each_cell(row.low - margin, row.high + margin, [&](int i, double from, double to) {
      const double weight = (to - from) * (bottom - top);
      result.rgb += mean(level, {i, j}) * weight;
      weights += weight;
      ++result.cells;
    });
  });
  result.rgb /= weights;
  return result;
}

}  // namespace lacuna
