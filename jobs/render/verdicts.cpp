#include "jobs/render/verdicts.h"

#include <fmt/format.h>

#include <cmath>

#include "jobs/spec/identity.h"

namespace lacuna {

template <>
inline constexpr bool is_plain<LogRatio> = true;

VerdictMemory cached_verdicts(ArtefactStore& store, const JobSpec& spec, const std::string& content,
                              double budget_seconds) {
  JobSpec any_seed = spec;
  any_seed.seed = JobSpec{}.seed;
  const int magnitude = int(std::floor(std::log2(budget_seconds) / 2));
  const ArtefactKey key = ArtefactKey("race_verdict", 2, fmt::format("magnitude={}", magnitude))
                              .from("picture", picture_key(any_seed))
                              .from("files", key_hash(content));
  return {.find = [&store, key] { return store.find<Verdict>(key); },
          .keep = [&store, key](const Verdict& v) { store.get<Verdict>(key, [&] { return v; }); }};
}

}  // namespace lacuna
