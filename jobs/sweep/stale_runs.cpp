#include "jobs/sweep/stale_runs.h"

#include <algorithm>
#include <vector>

namespace lacuna {

std::map<std::size_t, std::string> stale_runs(std::span<const RunResult> results) {
  std::vector<std::size_t> runs;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].state.state == State::done && !results[i].inputs.empty()) runs.push_back(i);
  }
  std::stable_sort(runs.begin(), runs.end(), [&](std::size_t a, std::size_t b) {
    return results[a].state.finished > results[b].state.finished;
  });
  // For each scene, by name, the latest files.
  std::map<std::string, InputList> latest;
  std::map<std::size_t, std::string> stale;
  for (const std::size_t i : runs) {
    const InputList& inputs = results[i].inputs;
    InputList& known = latest[inputs.front().name];
    if (const auto changes = changed_inputs(known, inputs); !changes.empty()) {
      stale[i] = changes.front();
      continue;
    }
    for (const InputFile& file : inputs) {
      const auto same = [&](const InputFile& k) {
        return k.role == file.role && k.name == file.name;
      };
      if (std::none_of(known.begin(), known.end(), same)) known.push_back(file);
    }
  }
  return stale;
}

}  // namespace lacuna
