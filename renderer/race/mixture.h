#pragma once

#include <span>
#include <vector>

#include "renderer/race/noise.h"

namespace lacuna {

/// Several methods render one picture, each for a share of the time. In a block their pictures are
/// averaged with weights in proportion to share over error: `errors` are the variances of a unit of
/// cost, that is of an iteration times its cost, above 0 in every block.

/// The shares, of sum 1, that minimise the sum over blocks of the variance of that average, 1 /
/// sum_k (share_k / error_k): a convex problem, solved by the multiplicative steps of optimal
/// designs (Silvey, Titterington and Torsney 1978).
std::vector<double> best_shares(std::span<const BlockSums> errors);

/// The total variance of a unit of cost of an average whose weights come from `shares` and
/// `assumed` errors, where the true ones are `errors`.
double mixed_error(std::span<const double> shares, std::span<const BlockSums> assumed,
                   std::span<const BlockSums> errors);

/// Block sums that a few iterations suffice for: a third is the mean of the four neighbours', and a
/// twentieth of the mean of all is added, so that no block is without noise.
BlockSums smoothed(const BlockGrid& grid, std::span<const double> sums);

}  // namespace lacuna
