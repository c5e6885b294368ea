#include "renderer/path/training_samples.h"

#include <algorithm>

namespace lacuna {

TrainingSamples::TrainingSamples(std::span<const Part> parts, std::size_t cells, double share)
    : first_(cells + 2, 0), share_(share) {
  const auto bucket = [cells](const TrainingSample& s) {
    return std::min<std::size_t>(s.cell.index, cells);
  };
  for (const Part& part : parts) {
    for (const TrainingSample& s : part) ++first_[bucket(s) + 1];
  }
  for (std::size_t c = 0; c <= cells; ++c) first_[c + 1] += first_[c];
  sorted_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const Part& part : parts) {
    for (const TrainingSample& s : part) sorted_[next[bucket(s)]++] = s;
  }
}

}  // namespace lacuna
