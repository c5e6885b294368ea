#include "renderer/race/mixture.h"

#include <algorithm>

namespace lacuna {

std::vector<double> best_shares(std::span<const BlockSums> errors) {
  constexpr int steps = 200;
  const std::size_t n = errors.size();
  std::vector<double> shares(n, 1 / double(n));
  for (int step = 0; step < steps && n > 1; ++step) {
    std::vector<double> gains(n, 0.0);
    double all = 0;
    for (std::size_t b = 0; b < errors[0].size(); ++b) {
      double precision = 0;
      for (std::size_t k = 0; k < n; ++k) precision += shares[k] / errors[k][b];
      if (!(precision > 0)) continue;
      all += 1 / precision;
      for (std::size_t k = 0; k < n; ++k) {
        gains[k] += 1 / errors[k][b] / (precision * precision);
      }
    }
    if (!(all > 0)) return shares;
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += shares[k] *= gains[k] / all;
    for (double& s : shares) s /= sum;
  }
  return shares;
}

double mixed_error(std::span<const double> shares, std::span<const BlockSums> assumed,
                   std::span<const BlockSums> errors) {
  double sum = 0;
  for (std::size_t b = 0; b < errors[0].size(); ++b) {
    double precision = 0, variance = 0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      if (!(shares[k] > 0)) continue;
      const double weight = shares[k] / assumed[k][b];
      precision += weight;
      variance += weight * weight * errors[k][b] / shares[k];
    }
    if (precision > 0) sum += variance / (precision * precision);
  }
  return sum;
}

BlockSums smoothed(const BlockGrid& grid, std::span<const double> sums) {
  const double floor = total(sums) / double(sums.size()) / 20;
  BlockSums result(sums.size());
  const auto at = [&](int x, int y) {
    return std::max(0.0, sums[std::size_t(y * grid.across + x)]);
  };
  for (int y = 0; y < grid.down; ++y) {
    for (int x = 0; x < grid.across; ++x) {
      double neighbours = 0;
      int count = 0;
      const auto add = [&](int u, int v) {
        if (u < 0 || v < 0 || u >= grid.across || v >= grid.down) return;
        neighbours += at(u, v);
        ++count;
      };
      add(x - 1, y);
      add(x + 1, y);
      add(x, y - 1);
      add(x, y + 1);
      const double around = count > 0 ? neighbours / count : at(x, y);
      result[std::size_t(y * grid.across + x)] = (2 * at(x, y) + around) / 3 + floor;
    }
  }
  return result;
}

}  // namespace lacuna
