#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/race/plan.h"
#include "renderer/race/race.h"

namespace lacuna {

/// What is told of a race and of what came of it.
struct RaceRecord {
  struct Candidate {
    std::string name = {};
    bool biased = false;
    bool racing = false;      ///< to the end of the race, or back since
    std::string reason = {};  ///< why it left, if it did
    int left_in = -1;         ///< round
    std::uint64_t iterations = 0;
    double cost = 0;         ///< of all its iterations
    double preparation = 0;  ///< seconds
    int share = 0;           ///< iterations in one estimate of the plan
    Standing standing = {};
  };
  std::vector<Candidate> candidates = {};
  std::vector<RaceRow> rows = {};
  double spent = 0;     ///< by the race itself
  int reduction = 1;    ///< of its pictures (BlockGrid)
  double limit = 0;     ///< what it might have spent; infinite: no limit
  double budget = 0;    ///< 0: not known
  bool seconds = true;  ///< costs are CPU seconds of each thread, otherwise rays
  double error = 0;     ///< expected mean squared error of a pixel times cost, of the plan
  double gain = 1;      ///< that error over the best candidate's alone
  /// The candidate with the largest weight in each block, rows of `across` blocks of `block`
  /// pixels; empty: the same everywhere.
  std::vector<int> blocks = {};
  /// Iterations of all candidates in one estimate of each block; empty: the same everywhere.
  std::vector<int> samples = {};
  int block = 0, across = 0;
};

}  // namespace lacuna
