#pragma once

#include "renderer/path/light_batch.h"
#include "renderer/path/tiles.h"

namespace lacuna {

/// Number of light paths that one part of a light pass traces: few enough to stop quickly.
inline constexpr std::int64_t paths_of_part = 16 * 64;

/// The number of light paths of an iteration: `wanted`, or one for each pixel if that is 0.
inline std::int64_t light_paths(int wanted, const Image& image) {
  return wanted > 0 ? wanted : std::int64_t{image.width} * image.height;
}

/// The light paths [0, paths) of an iteration, and the picture that their splats are added to.
struct LightPathPass {
  const IterationContext& context;
  const LightPathSetting& setting;
  std::int64_t paths;
  Image& image;
};

/// Traces the light paths of `pass` in parts of `paths_of_part`. If SampleCounts::splat > 0, adds
/// their splats (t = 1) to the image and calls `arrived(splat)` for each. Calls `keep(path, batch,
/// i)` for each traced path, which has index `i` in `batch`: in order within a part, from several
/// threads.
template <class Keep, class Arrived>
Counters light_pass(const LightPathPass& pass, const Guide& guide, Keep&& keep, Arrived&& arrived) {
  const IterationContext& context = pass.context;
  const LightPathSetting& setting = pass.setting;
  const std::int64_t paths = pass.paths;
  using Batch = LightBatch;
  constexpr std::uint64_t no_path = (std::uint64_t{1} << 56) - 1;
  const std::uint32_t start =
      Rng(context.seed, context.iteration, no_path, Rng::Purpose::light_path).next_u32();
  const auto choice = [&](std::int64_t j) {  // modulo 2^32
    return start + static_cast<std::uint32_t>((static_cast<std::uint64_t>(j) << 32) /
                                              static_cast<std::uint64_t>(paths));
  };
  const auto work = [&](int i, Counters& counters, Splats& splats) {
    Batch batch(setting, guide);
    std::vector<Rng> rngs;
    std::vector<std::uint32_t> choices;
    const std::int64_t end = std::min(paths, (i + 1) * paths_of_part);
    for (std::int64_t first = i * paths_of_part; first < end; first += Batch::size) {
      context.check_stop();
      rngs.clear();
      choices.clear();
      for (std::int64_t j = first; j < std::min(end, first + Batch::size); ++j) {
        rngs.push_back(context.shared_path_numbers(static_cast<std::uint64_t>(j),
                                                   static_cast<std::uint64_t>(paths),
                                                   Rng::Purpose::light_path));
        if (setting.spread) choices.push_back(choice(j));
      }
      batch.walk(rngs, counters, choices);
      if (setting.counts.splat > 0) batch.splat(rngs.size(), counters, splats);
      for (std::size_t k = 0; k < rngs.size(); ++k) {
        keep(static_cast<std::size_t>(first) + k, batch, k);
      }
    }
  };
  return for_each_splatting_part(context,
                                 static_cast<int>((paths + paths_of_part - 1) / paths_of_part),
                                 pass.image, work, arrived);
}

}  // namespace lacuna
