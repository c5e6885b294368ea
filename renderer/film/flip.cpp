#include "renderer/film/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "analysis/geometry/simd.h"
#include "renderer/film/flip_colour.h"
#include "renderer/film/flip_filters.h"

namespace lacuna {
namespace {

// A strip of tiles is the work of one thread. The planes of a tile fit into the second cache.
constexpr int tile_columns = 128, tile_rows = 64;

/// The pixels of a tile, one value each.
using Plane = std::vector<float>;

struct Tile {
  int x, y, columns, rows;
  std::size_t pixels() const {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
};

/// The input of a filter: `rows` rows, `stride` values apart, and the taps `step` values apart.
struct FilterInput {
  const float* first;
  int step, stride;
};

/// Filters along one dimension into `out`, of `columns` columns.
void filter(const FilterInput& in, const FlipKernel& kernel, int rows, int columns, float* out) {
  const std::size_t taps = kernel.weights.size();
  for (int y = 0; y < rows; ++y) {
    const float* from = in.first + std::ptrdiff_t{y} * in.stride - kernel.radius * in.step;
    float* to = out + std::ptrdiff_t{y} * columns;
    int x = 0;
    for (; x + 32 <= columns; x += 32) {
      Float8 a, b, c, d;
      const float* tap = from + x;
      for (std::size_t k = 0; k < taps; ++k, tap += in.step) {
        const Float8 w = kernel.weights[k];
        a = a + w * Float8::load_unaligned(tap);
        b = b + w * Float8::load_unaligned(tap + 8);
        c = c + w * Float8::load_unaligned(tap + 16);
        d = d + w * Float8::load_unaligned(tap + 24);
      }
      a.store_unaligned(to + x);
      b.store_unaligned(to + x + 8);
      c.store_unaligned(to + x + 16);
      d.store_unaligned(to + x + 24);
    }
    for (; x < columns; ++x) {
      float sum = 0;
      for (std::size_t k = 0; k < taps; ++k) {
        sum += kernel.weights[k] * from[x + static_cast<std::ptrdiff_t>(k) * in.step];
      }
      to[x] = sum;
    }
  }
}

/// A tile of a picture as FLIP's observer perceives it.
class PerceivedTile {
 public:
  /// Perceives a tile of a picture, in the memory of the one before. `shown` maps radiance to a
  /// value in [0, 1].
  template <class Shown>
  void perceive(std::span<const double> rgb, int width, int height, const Tile& tile,
                const Shown& shown) {
    tile_ = tile;
    stride_ = tile.columns + 2 * reach_;
    load(rgb, width, height, shown);
    across_.resize(static_cast<std::size_t>(tile.rows + 2 * reach_) *
                   static_cast<std::size_t>(tile.columns));
    for (Plane& p : filtered_) p.resize(tile.pixels());
    blur();
    adapt();
    const FlipFilters& f = flip_filters();
    detect(f.edge, f.across, edge_);
    detect(f.point, f.across, point_);
  }

  /// The colour of the tile's i-th pixel after the eye's blur, in L*a*b* with the Hunt effect.
  FlipColour lab(std::size_t i) const { return {lab_[0][i], lab_[1][i], lab_[2][i]}; }
  /// The strengths of its features.
  float edge(std::size_t i) const { return edge_[i]; }
  float point(std::size_t i) const { return point_[i]; }

 private:
  /// Opponent colours YCxCz of the tile and its surroundings, without their constant factors. The
  /// picture's border pixels continue beyond it.
  template <class Shown>
  void load(std::span<const double> rgb, int width, int height, const Shown& shown) {
    const int rows = tile_.rows + 2 * reach_;
    for (Plane& p : opponent_) {
      p.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride_));
    }
    row_.resize(3 * static_cast<std::size_t>(stride_));
    for (int v = 0; v < rows; ++v) {
      const int line = std::clamp(tile_.y + v - reach_, 0, height - 1);
      const double* from = rgb.data() + std::ptrdiff_t{line} * 3 * width;
      for (int u = 0; u < stride_; ++u) {
        const double* p = from + 3 * std::clamp(tile_.x + u - reach_, 0, width - 1);
        for (int c = 0; c < 3; ++c) row_[static_cast<std::size_t>(c * stride_ + u)] = float(p[c]);
      }
      const float *r = row_.data(), *g = r + stride_, *b = g + stride_;
      float* to[3];
      for (std::size_t c = 0; c < 3; ++c) to[c] = opponent_[c].data() + std::ptrdiff_t{v} * stride_;
      for (int u = 0; u < stride_; ++u) {
        const FlipColour c = flip_colour::relative_xyz(shown(r[u]), shown(g[u]), shown(b[u]));
        to[0][u] = c.y;
        to[1][u] = c.x - c.y;
        to[2][u] = c.y - c.z;
      }
    }
  }

  /// Filters with the product of a filter along rows and one along columns.
  void convolve(const Plane& in, const FlipKernel& along, const FlipKernel& down, Plane& out) {
    const int columns = tile_.columns;
    filter({in.data() + reach_, 1, stride_}, along, tile_.rows + 2 * reach_, columns,
           across_.data());
    filter({across_.data() + std::ptrdiff_t{reach_} * columns, columns, columns}, down, tile_.rows,
           columns, out.data());
  }

  void blur() {
    const FlipFilters& f = flip_filters();
    convolve(opponent_[0], f.achromatic, f.achromatic, filtered_[0]);
    convolve(opponent_[1], f.red_green, f.red_green, filtered_[1]);
    convolve(opponent_[2], f.blue_yellow[0], f.blue_yellow[0], filtered_[2]);
    convolve(opponent_[2], f.blue_yellow[1], f.blue_yellow[1], filtered_[3]);
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      filtered_[2][i] =
          f.blue_yellow_share[0] * filtered_[2][i] + f.blue_yellow_share[1] * filtered_[3][i];
    }
  }

  /// L*a*b* of the blurred colours.
  void adapt() {
    for (Plane& p : lab_) p.resize(tile_.pixels());
    const auto clipped = [](float v) { return std::min(std::max(v, 0.0F), 1.0F); };
    for (std::size_t i = 0; i < tile_.pixels(); ++i) {
      const float y = filtered_[0][i];
      FlipColour c = flip_colour::linear_rgb({y + filtered_[1][i], y, y - filtered_[2][i]});
      c = flip_colour::hunt_lab(
          flip_colour::relative_xyz(clipped(c.x), clipped(c.y), clipped(c.z)));
      lab_[0][i] = c.x;
      lab_[1][i] = c.y;
      lab_[2][i] = c.z;
    }
  }

  /// The strength of a feature at each pixel, over both of its directions.
  void detect(const FlipKernel& feature, const FlipKernel& across, Plane& strength) {
    convolve(opponent_[0], feature, across, filtered_[0]);
    convolve(opponent_[0], across, feature, filtered_[1]);
    strength.resize(tile_.pixels());
    for (std::size_t i = 0; i < strength.size(); ++i) {
      strength[i] =
          std::sqrt(filtered_[0][i] * filtered_[0][i] + filtered_[1][i] * filtered_[1][i]);
    }
  }

  Tile tile_{};
  int reach_ = flip_filters().reach;
  int stride_ = 0;
  std::vector<float> row_;
  std::array<Plane, 3> opponent_, lab_;
  Plane across_;
  std::array<Plane, 4> filtered_;
  Plane edge_, point_;
};

/// The colour difference in [0, 1] (2020, section 4.1.4): small distances get most of the range.
class ColourDifference {
 public:
  ColourDifference() {
    const auto lab = [](float r, float g, float b) {
      return flip_colour::hunt_lab(flip_colour::relative_xyz(r, g, b));
    };
    largest_ = std::pow(flip_colour::hyab(lab(0, 1, 0), lab(0, 0, 1)), exponent);
  }
  float operator()(const FlipColour& p, const FlipColour& q) const {
    constexpr float share = 0.4F, range = 0.95F;
    const float d = std::pow(flip_colour::hyab(p, q), exponent), knee = share * largest_;
    return d < knee ? range / knee * d : range + (d - knee) / (largest_ - knee) * (1 - range);
  }

 private:
  static constexpr float exponent = 0.7F;
  float largest_;  // between green and blue
};

/// FLIP of the i-th pixel of a tile (2020, eq. 11 and section 4.3).
float pixel_flip(const PerceivedTile& a, const PerceivedTile& b, std::size_t i,
                 const ColourDifference& difference) {
  const float colour = difference(a.lab(i), b.lab(i));
  const float feature =
      std::max(std::abs(a.edge(i) - b.edge(i)), std::abs(a.point(i) - b.point(i)));
  return std::pow(colour, 1 - std::sqrt(feature / std::numbers::sqrt2_v<float>));
}

/// Raises `map` to the FLIP of the shown pictures.
template <class Shown>
void raise(const FlipPictures& p, const Shown& shown, std::vector<float>& map,
           const ThreadPool* pool) {
  const ColourDifference difference;
  const auto compare_rows = [&](int strip) {
    PerceivedTile a, b;
    const int y = strip * tile_rows;
    for (int x = 0; x < p.width; x += tile_columns) {
      const Tile tile{x, y, std::min(tile_columns, p.width - x), std::min(tile_rows, p.height - y)};
      a.perceive(p.estimate, p.width, p.height, tile, shown);
      b.perceive(p.reference, p.width, p.height, tile, shown);
      std::size_t i = 0;
      for (int v = y; v < y + tile.rows; ++v) {
        float* row = map.data() + std::ptrdiff_t{v} * p.width;
        for (int u = x; u < x + tile.columns; ++u, ++i) {
          const float flip = pixel_flip(a, b, i, difference);
          if (!(flip <= row[u])) row[u] = flip;  // also NaN
        }
      }
    }
  };
  const int strips = (p.height + tile_rows - 1) / tile_rows;
  if (pool != nullptr) return pool->for_each(strips, compare_rows);
  for (int s = 0; s < strips; ++s) compare_rows(s);
}

std::vector<float> empty_map(const FlipPictures& p) {
  const auto pixels = static_cast<std::size_t>(std::max(p.width, 0)) *
                      static_cast<std::size_t>(std::max(p.height, 0));
  if (p.estimate.size() != 3 * pixels || p.reference.size() != 3 * pixels || pixels == 0) {
    throw std::invalid_argument("the two pictures have different sizes");
  }
  return std::vector<float>(pixels, 0);
}

}  // namespace

FlipExposures flip_exposures(std::span<const double> reference) {
  std::vector<double> luminances;
  for (std::size_t i = 0; i + 2 < reference.size(); i += 3) {
    const double y = 0.2126 * reference[i] + 0.7152 * reference[i + 1] + 0.0722 * reference[i + 2];
    if (std::isfinite(y) && y > 0) luminances.push_back(y);
  }
  if (luminances.empty()) return {};
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const double median = *middle, largest = *std::max_element(middle, luminances.end());
  // aces(x) = target: a quadratic equation in x.
  using namespace flip_colour;
  constexpr double target = 0.85;
  const double a = aces_p0 - target * aces_q0, b = aces_p1 - target * aces_q1,
               c = -target * aces_q2;
  const double x = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
  FlipExposures e{std::log2(x / largest), std::log2(x / median), 2};
  e.count = std::max(2, static_cast<int>(std::ceil(e.stop - e.start)));
  return e;
}

std::vector<float> ldr_flip(const FlipPictures& pictures, double exposure, const ThreadPool* pool) {
  std::vector<float> map = empty_map(pictures);
  const auto shown = [scale = float(exposure)](float v) {
    return std::min(std::max(v * scale, 0.0F), 1.0F);
  };
  raise(pictures, shown, map, pool);
  return map;
}

std::vector<float> hdr_flip(const FlipPictures& pictures, const FlipExposures& exposures,
                            const ThreadPool* pool) {
  std::vector<float> map = empty_map(pictures);
  for (int i = 0; i < exposures.count; ++i) {
    const auto scale = static_cast<float>(std::exp2(exposures.at(i)));
    raise(
        pictures, [scale](float v) { return flip_colour::aces(v * scale); }, map, pool);
  }
  return map;
}

double flip_mean(std::span<const float> map) {
  return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

}  // namespace lacuna
