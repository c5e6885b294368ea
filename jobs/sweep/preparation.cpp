#include "jobs/sweep/preparation.h"

#include <algorithm>

namespace lacuna {
namespace {

std::optional<double> smaller(std::optional<double> a, double b) { return a ? std::min(*a, b) : b; }

}  // namespace

Preparation preparation(std::span<const RunResult* const> cell,
                        std::span<const RunResult* const> same_space) {
  Preparation p;
  std::set<std::string> needed;
  std::optional<double> load;
  for (const RunResult* run : cell) {
    if (!run->preparation) continue;
    const RunPreparation& r = *run->preparation;
    load = smaller(load, r.load);
    if (r.built.empty()) p.warm = smaller(p.warm, r.load + r.analysis);
    if (r.loaded.empty()) p.cold = smaller(p.cold, r.load + r.analysis);
    needed.insert(r.loaded.begin(), r.loaded.end());
  }
  if (p.cold || !load) return p;
  for (const RunResult* run : same_space) {
    if (!run->preparation || !run->preparation->loaded.empty()) continue;
    const std::set<std::string>& built = run->preparation->built;
    if (!std::includes(built.begin(), built.end(), needed.begin(), needed.end())) continue;
    p.cold = smaller(p.cold, *load + run->preparation->analysis);
  }
  return p;
}

}  // namespace lacuna
