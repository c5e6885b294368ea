#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/film/image.h"
#include "renderer/path/tile.h"
#include "renderer/race/race.h"

namespace lacuna {

/// How the iterations of entrants make one estimate of the picture: in each block the mean of each
/// entrant's iterations there, and a weighted mean of these. Numbers and weights are fixed before
/// the iterations are rendered, and the sum of weights is 1, so that the estimate is unbiased if
/// each is.
struct Plan {
  std::vector<int> iterations;  ///< of each entrant, the most of any block; 0: it takes no part
  /// Of each entrant that takes part, the iterations of each block: at least 1, and `iterations`
  /// everywhere if it renders whole pictures only.
  std::vector<std::vector<int>> counts;
  std::vector<std::vector<float>> weights;  ///< of each entrant that takes part, in each block
  double error = 0;  ///< expected mean squared error of a pixel times cost; 0: not known
  double gain = 1;   ///< that error over the best entrant's, judged by halves

  /// How many take part.
  int methods() const;
  /// Whether an entrant has more iterations in some blocks than in others.
  bool is_adaptive() const;
};

/// What a plan may do.
struct PlanFreedom {
  double cost = 0;      ///< of one estimate, if the entrants' iterations are not longer
  bool regions = true;  ///< several entrants may share
  /// Of each entrant: it may have more iterations in some blocks than in others. Empty: none may.
  std::vector<std::uint8_t> by_block = {};

  bool adapts() const;
};

/// The plan with the least error: the best entrant alone, or several that share the time, and
/// blocks that need more of it, where one half of their trials says that they would have had a
/// clearly smaller error in the other half.
Plan make_plan(const Race& race, const PlanFreedom& freedom);

/// The parts of the picture that an entrant's iteration number `i` of an estimate renders, in rows;
/// `drawn`: the samples of each block in earlier estimates, which come before these in their
/// sequences (Tile::samples_before). Adds their pixels to `pixels`.
std::vector<Tile> parts_of(const Plan& plan, const BlockGrid& grid, std::size_t entrant, int i,
                           std::span<const std::uint64_t> drawn, std::size_t& pixels);

/// The estimate of a plan: `sums` holds the sum of the iterations of each entrant that takes part.
void combine(const Plan& plan, const BlockGrid& grid, const std::vector<Image>& sums, Image& out);

}  // namespace lacuna
