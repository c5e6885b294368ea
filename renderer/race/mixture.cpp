#include "renderer/race/mixture.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

/// What a little more time for each method in each block would take off the variance, per block.
void find_gains(std::span<const BlockSums> errors, const Shares& shares, Shares& gains) {
  for (std::size_t b = 0; b < errors[0].size(); ++b) {
    double precision = 0;
    for (std::size_t k = 0; k < errors.size(); ++k) precision += shares[k][b] / errors[k][b];
    for (std::size_t k = 0; k < errors.size(); ++k) {
      gains[k][b] = precision > 0 ? 1 / errors[k][b] / (precision * precision) : 0;
    }
  }
}

}  // namespace

double share_of(const BlockSums& in_blocks) { return total(in_blocks) / double(in_blocks.size()); }

Shares best_shares(std::span<const BlockSums> errors, std::span<const std::uint8_t> by_block) {
  constexpr int steps = 400;
  const std::size_t n = errors.size(), blocks = errors[0].size();
  Shares shares(n, BlockSums(blocks, 1 / double(n))), gains = shares;
  const bool nothing_to_choose = n < 2 && (by_block.empty() || by_block[0] == 0);
  for (int step = 0; step < steps && !nothing_to_choose; ++step) {
    find_gains(errors, shares, gains);
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (by_block.empty() || by_block[k] == 0) gains[k].assign(blocks, share_of(gains[k]));
      for (std::size_t b = 0; b < blocks; ++b) shares[k][b] *= std::sqrt(gains[k][b]);
      sum += share_of(shares[k]);
    }
    for (BlockSums& share : shares) {
      for (double& s : share) s /= sum;
    }
  }
  return shares;
}

double mixed_error(const Shares& shares, std::span<const BlockSums> assumed,
                   std::span<const BlockSums> errors) {
  double sum = 0;
  for (std::size_t b = 0; b < errors[0].size(); ++b) {
    double precision = 0, variance = 0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      if (!(shares[k][b] > 0)) continue;
      const double weight = shares[k][b] / assumed[k][b];
      precision += weight;
      variance += weight * weight * errors[k][b] / shares[k][b];
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
