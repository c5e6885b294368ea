#pragma once

#include <vector>

#include "renderer/film/image.h"
#include "renderer/race/race.h"

namespace lacuna {

/// How the iterations of entrants make one estimate of the picture: the mean of each entrant's
/// iterations, and in each block a weighted mean of these. The weights are fixed before the
/// iterations are rendered, and their sum is 1, so that the estimate is unbiased if each is.
struct Plan {
  std::vector<int> iterations;              ///< of each entrant; 0: it does not take part
  std::vector<std::vector<float>> weights;  ///< of each entrant that takes part, in each block
  double error = 0;  ///< expected mean squared error of a pixel times cost; 0: not known
  double gain = 1;   ///< that error over the best entrant's, judged by halves

  /// How many take part.
  int methods() const;
};

/// The plan with the least error: the best entrant alone, or several that share the time where one
/// half of their trials says that they would have had a clearly smaller error in the other half.
/// `cost`: of one estimate, if the entrants' iterations are not longer; `regions`: whether several
/// may share.
Plan make_plan(const Race& race, double cost, bool regions);

/// The estimate of a plan: `sums` holds the sum of the iterations of each entrant that takes part.
void combine(const Plan& plan, const BlockGrid& grid, const std::vector<Image>& sums, Image& out);

}  // namespace lacuna
