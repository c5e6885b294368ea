#include "renderer/path/training_samples.h"

#include <algorithm>

namespace lacuna {

TrainingSamples::TrainingSamples(std::span<const Part> parts, std::size_t cells,
                                 const ThreadPool& pool, double share)
    : share_(share) {
  std::size_t n = 0;
  for (const Part& part : parts) n += part.size();
  sorted_.resize(n);
  sort_.sort(
      parts.size(), cells + 1,
      [&](std::size_t b, const auto& use) {
        for (const TrainingSample& s : parts[b]) {
          use(std::min<std::size_t>(s.cell.index, cells), &s);
        }
      },
      [&](std::size_t k, const TrainingSample* s) { sorted_.set(k, *s); }, pool);
}

}  // namespace lacuna
