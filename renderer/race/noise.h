#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "renderer/film/image.h"
#include "renderer/race/block_grid.h"
#include "renderer/race/trial.h"

namespace lacuna {

/// Squared errors summed over the pixels of each block of a picture (BlockGrid).
using BlockSums = std::vector<double>;

double total(std::span<const double> sums);

/// A logarithm of a ratio of two totals, and its standard deviation.
struct LogRatio {
  double value = 0, deviation = 0;
};

/// log(total(a) / total(b)), by a jackknife over 8 x 8 parts of the picture: where a few pixels
/// carry the sums it is not known. 0 if both are 0, infinite if one is not above 0.
LogRatio log_ratio(const BlockGrid& grid, std::span<const double> a, std::span<const double> b);

/// log(total(a) / total(b)) without the blocks that carry most of either, a twentieth of all for
/// each: what rare bright paths do not decide. None if a total is not above 0 then.
std::optional<double> typical_log_ratio(std::span<const double> a, std::span<const double> b);

/// The variance of each of three or more independent estimates of one picture, of which there is
/// only one each: from the squared differences of all pairs, d_ij = v_i + v_j, by least squares
/// (the "three-cornered hat", Gray and Allan 1974). Sums of a block may be below 0.
std::vector<BlockSums> variances_of_singles(const BlockGrid& grid,
                                            std::span<const Image* const> estimates);

/// The squared error of a trial's mean that its own variance does not explain: the squared
/// difference to the mean of others, weighted by their precision, less the variances of both. A
/// method that has not yet found a bright path, or never finds it, shows none in its own variance.
/// `variances`: of one iteration of each trial; trials with fewer than two estimates or without
/// variance do not count among the others, nor do those whose pictures have pixels of another size.
/// All 0 where there are no others.
BlockSums unexplained_error(std::span<const Trial* const> trials,
                            std::span<const BlockSums> variances, std::size_t which);

/// The standard deviation of a total, by the same jackknife.
double standard_deviation(const BlockGrid& grid, std::span<const double> sums);

}  // namespace lacuna
