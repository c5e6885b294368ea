#include "renderer/race/noise.h"

#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace lacuna {

namespace {

constexpr int parts_across = 8;
using Parts = std::array<double, std::size_t{parts_across} * parts_across>;

/// Sums over the parts of the picture.
Parts parts_of(const BlockGrid& grid, std::span<const double> sums) {
  Parts parts{};
  for (std::size_t b = 0; b < sums.size(); ++b) {
    const int x = int(b) % grid.across * parts_across / grid.across;
    const int y = int(b) / grid.across * parts_across / grid.down;
    parts[std::size_t(y * parts_across + x)] += sums[b];
  }
  return parts;
}

/// The standard deviation of a statistic, from its values with one part left out.
double jackknife(std::span<const double> without_one) {
  const auto n = double(without_one.size());
  const double mean = std::accumulate(without_one.begin(), without_one.end(), 0.0) / n;
  double squares = 0;
  for (const double v : without_one) squares += (v - mean) * (v - mean);
  return std::sqrt((n - 1) / n * squares);
}

void add_squared_difference(const BlockGrid& grid, const Image& a, const Image& b,
                            BlockSums& sums) {
  std::size_t i = 0;
  for (int y = 0; y < grid.trial_height(); ++y) {
    for (int x = 0; x < grid.trial_width(); ++x, ++i) {
      const Rgb d = a.pixels[i] - b.pixels[i];
      const double square = double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z;
      sums[grid.block_of(x, y)] += square / 3 * grid.weight(x, y);
    }
  }
}

}  // namespace

double total(std::span<const double> sums) {
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

LogRatio log_ratio(const BlockGrid& grid, std::span<const double> a, std::span<const double> b) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const double sum_a = total(a), sum_b = total(b);
  if (!(sum_a > 0) && !(sum_b > 0)) return {};
  if (!(sum_a > 0)) return {-infinite, 0};
  if (!(sum_b > 0)) return {infinite, 0};
  const Parts parts_a = parts_of(grid, a), parts_b = parts_of(grid, b);
  std::vector<double> without;
  for (std::size_t p = 0; p < parts_a.size(); ++p) {
    const double rest_a = sum_a - parts_a[p], rest_b = sum_b - parts_b[p];
    // One part holds all: nothing is known.
    if (!(rest_a > 0) || !(rest_b > 0)) return {std::log(sum_a / sum_b), infinite};
    without.push_back(std::log(rest_a / rest_b));
  }
  return {std::log(sum_a / sum_b), jackknife(without)};
}

std::optional<double> typical_log_ratio(std::span<const double> a, std::span<const double> b) {
  constexpr std::size_t part = 20;
  const auto limit = [&](std::span<const double> sums) {
    std::vector<double> sorted(sums.begin(), sums.end());
    const auto at = sorted.end() - std::ptrdiff_t((sorted.size() + part - 1) / part);
    std::nth_element(sorted.begin(), at, sorted.end());
    return *at;
  };
  const double below_a = limit(a), below_b = limit(b);
  double sum_a = 0, sum_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] >= below_a || b[i] >= below_b) continue;
    sum_a += a[i];
    sum_b += b[i];
  }
  if (!(sum_a > 0) || !(sum_b > 0)) return std::nullopt;
  return std::log(sum_a / sum_b);
}

double standard_deviation(const BlockGrid& grid, std::span<const double> sums) {
  const double sum = total(sums);
  std::vector<double> without;
  for (const double part : parts_of(grid, sums)) without.push_back(sum - part);
  return jackknife(without);
}

std::vector<BlockSums> variances_of_singles(const BlockGrid& grid,
                                            std::span<const Image* const> estimates) {
  const std::size_t n = estimates.size();
  std::vector<BlockSums> variances(n, BlockSums(grid.blocks(), 0.0));
  BlockSums all(grid.blocks(), 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      BlockSums d(grid.blocks(), 0.0);
      add_squared_difference(grid, *estimates[i], *estimates[j], d);
      for (std::size_t b = 0; b < d.size(); ++b) {
        variances[i][b] += d[b];
        variances[j][b] += d[b];
        all[b] += d[b];
      }
    }
  }
  for (BlockSums& v : variances) {
    for (std::size_t b = 0; b < v.size(); ++b) {
      v[b] = (v[b] - all[b] / double(n - 1)) / double(n - 2);
    }
  }
  return variances;
}

BlockSums unexplained_error(std::span<const Trial* const> trials,
                            std::span<const BlockSums> variances, std::size_t which) {
  const Trial& one = *trials[which];
  const BlockGrid& grid = one.grid();
  BlockSums error(grid.blocks(), 0.0);
  Image others(grid.trial_width(), grid.trial_height());
  BlockSums variance(grid.blocks(), 0.0);  // of `others`, times the square of the weights' sum
  double weights = 0;
  for (std::size_t j = 0; j < trials.size(); ++j) {
    const double v = total(variances[j]);
    const bool same_pixels = trials[j]->grid().reduction == grid.reduction;
    if (j == which || trials[j]->estimates() < 2 || !(v > 0) || !same_pixels) continue;
    const double n = double(trials[j]->estimates());
    const double weight = n / v;
    weights += weight;
    const auto step = float(weight / weights);
    for (std::size_t i = 0; i < others.pixels.size(); ++i) {
      others.pixels[i] += (trials[j]->mean().pixels[i] - others.pixels[i]) * step;
    }
    for (std::size_t b = 0; b < variance.size(); ++b) {
      variance[b] += variances[j][b] / n * weight * weight;
    }
  }
  if (!(weights > 0) || one.estimates() == 0) return error;
  add_squared_difference(grid, one.mean(), others, error);
  for (std::size_t b = 0; b < error.size(); ++b) {
    error[b] -= variance[b] / (weights * weights) + variances[which][b] / double(one.estimates());
  }
  return error;
}

}  // namespace lacuna
