#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/race/noise.h"

namespace lacuna {

/// Several methods render one picture, each for a share of the time. In a block their pictures are
/// averaged with weights in proportion to share over error: `errors` are the variances of a unit of
/// cost, that is of an iteration times its cost, above 0 in every block.

/// The share of each method in each block: what it costs there over what a block costs on average,
/// so that the mean over blocks of the sum over methods is 1. The same in every block for a method
/// that renders whole pictures.
using Shares = std::vector<BlockSums>;

/// The part of the time of a method.
double share_of(const BlockSums& in_blocks);

/// The shares that minimise the sum over blocks of the variance of that average, 1 / sum_k (share_k
/// / error_k): a convex problem, solved by the multiplicative steps of optimal designs (Silvey,
/// Titterington and Torsney 1978), with the square root that suits a sum of variances (Torsney
/// 1983). `by_block`: of each method, whether it can render blocks by themselves; empty: none can.
Shares best_shares(std::span<const BlockSums> errors, std::span<const std::uint8_t> by_block = {});

/// The total variance of a unit of cost of an average whose weights come from `shares` and
/// `assumed` errors, where the true ones are `errors`.
double mixed_error(const Shares& shares, std::span<const BlockSums> assumed,
                   std::span<const BlockSums> errors);

/// Block sums that a few iterations suffice for: a third is the mean of the four neighbours', and a
/// twentieth of the mean of all is added, so that no block is without noise.
BlockSums smoothed(const BlockGrid& grid, std::span<const double> sums);

}  // namespace lacuna
