#include "jobs/run/verdicts.h"

#include <fmt/format.h>

#include <cmath>

#include "jobs/spec/identity.h"
#include "renderer/integrators/candidates.h"

namespace lacuna {

template <>
inline constexpr bool is_plain<LogRatio> = true;

VerdictMemory cached_verdicts(ArtefactStore& store, const JobSpec& spec, const std::string& content,
                              double budget_seconds) {
  JobSpec any_seed = spec;
  any_seed.seed = JobSpec{}.seed;
  const int magnitude = int(std::floor(std::log2(budget_seconds) / 2));
  ArtefactKey key = ArtefactKey("race_verdict", 2, fmt::format("magnitude={}", magnitude))
                        .from("picture", picture_key(any_seed))
                        .from("files", key_hash(content));
  // By default they are what this version takes.
  if (const auto* race = std::get_if<AutoSettings>(&spec.integrator)) {
    for (const IntegratorSettings& c : candidates(*race)) {
      any_seed.integrator = c;
      key.from("candidate", picture_key(any_seed));
    }
  }
  return {.find = [&store, key] { return store.find<Verdict>(key); },
          .keep = [&store, key](const Verdict& v) { store.get<Verdict>(key, [&] { return v; }); }};
}

}  // namespace lacuna
