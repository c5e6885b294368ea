#include "jobs/report/replicate_bias.h"

#include <cmath>
#include <map>
#include <stdexcept>

namespace lacuna {

ReplicateBias::ReplicateBias(std::vector<double> reference, int width)
    : reference_(std::move(reference)),
      sum_(reference_.size(), 0),
      squares_(reference_.size(), 0),
      width_(static_cast<std::size_t>(width)) {}

void ReplicateBias::add(std::span<const double> picture) {
  if (picture.size() != reference_.size()) {
    throw std::invalid_argument("a replicate's picture differs in size from the reference");
  }
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const double error = picture[i] - reference_[i];
    sum_[i] += error;
    squares_[i] += error * error;
  }
  ++n_;
}

std::optional<Estimate> ReplicateBias::bias_squared(std::optional<double> reference_mse) const {
  if (n_ < 2) return {};
  constexpr std::size_t side = 16;
  const auto pairs = static_cast<double>(n_ * (n_ - 1));
  struct Block {
    double sum = 0, count = 0;
  };
  std::map<std::pair<std::size_t, std::size_t>, Block> blocks;
  for (std::size_t i = 0; i < sum_.size(); ++i) {
    const std::size_t x = (i / 3) % width_, y = (i / 3) / width_;
    Block& block = blocks[{y / side, x / side}];
    block.sum += (sum_[i] * sum_[i] - squares_[i]) / pairs;
    block.count += 1;
  }
  // Blocks at the border are smaller: use a ratio of sums, with the variance of its residuals.
  double total = 0, count = 0, residuals = 0;
  for (const auto& [place, b] : blocks) {
    total += b.sum;
    count += b.count;
  }
  const double mean_product = total / count;
  for (const auto& [place, b] : blocks) {
    const double residual = b.sum - mean_product * b.count;
    residuals += residual * residual;
  }
  Estimate e{mean_product - reference_mse.value_or(0), {}, n_};
  const auto k = static_cast<double>(blocks.size());
  if (k < 4) return e;
  constexpr double normal_bound = 1.959963984540054;  // for `confidence`
  const double half = normal_bound * std::sqrt(residuals * k / (k - 1)) / count;
  e.interval = {e.value - half, e.value + half};
  return e;
}

}  // namespace lacuna
