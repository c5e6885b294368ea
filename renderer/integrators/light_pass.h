#pragma once

#include "renderer/integrators/tiles.h"
#include "renderer/path/light_batch.h"

namespace lacuna {

/// Walks the light paths [0, paths) of an iteration, adds what they give at the eye (t = 1), if
/// that strategy has samples, to `image` and to `arrived(splat)`, and calls `keep(path, batch,
/// place)` for each once it is walked, from several threads.
template <class Guide, class Keep, class Arrived>
Counters light_pass(const IterationContext& context, const LightPathSetting& setting,
                    const Guide& guide, std::int64_t paths, Image& image, Keep&& keep,
                    Arrived&& arrived) {
  using Batch = LightBatch<Guide>;
  constexpr std::int64_t part = 16 * Batch::size;  // small enough to stop quickly
  const auto work = [&](int i, Counters& counters, Splats& splats) {
    Batch batch(setting, guide);
    std::vector<Rng> rngs;
    const std::int64_t end = std::min(paths, (i + 1) * part);
    for (std::int64_t first = i * part; first < end; first += Batch::size) {
      rngs.clear();
      for (std::int64_t j = first; j < std::min(end, first + Batch::size); ++j) {
        rngs.emplace_back(context.seed, context.iteration, static_cast<std::uint64_t>(j),
                          Rng::Purpose::light_path);
      }
      batch.walk(rngs, counters);
      if (setting.counts.splat > 0) batch.splat(rngs.size(), counters, splats);
      for (std::size_t k = 0; k < rngs.size(); ++k) {
        keep(static_cast<std::size_t>(first) + k, batch, k);
      }
    }
  };
  return for_each_splatting_part(context, static_cast<int>((paths + part - 1) / part), image, work,
                                 arrived);
}

}  // namespace lacuna
