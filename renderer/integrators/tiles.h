#pragma once

#include <atomic>
#include <vector>

#include "renderer/integrators/integrator.h"

namespace lacuna {

/// Estimates every pixel once, tile by tile in parallel. `estimate(x, y, rng, counters, scratch)`
/// gives one sample of pixel (x, y); `rng` is its own stream. `make_scratch()` makes what a tile
/// can reuse. Values that are not finite are dropped and counted.
template <class MakeScratch, class Estimate>
Counters for_each_pixel(const IterationContext& context, Image& image, MakeScratch&& make_scratch,
                        Estimate&& estimate) {
  constexpr int size = 32;  // pixels; small enough to stop quickly, large enough to be coherent
  const int across = (image.width + size - 1) / size;
  const int down = (image.height + size - 1) / size;
  std::vector<Counters> counters(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  std::atomic<bool> stopped{false};
  context.pool.for_each(across * down, [&](int tile) {
    if (stopped || context.stop()) {
      stopped = true;
      return;
    }
    auto scratch = make_scratch();
    Counters count;  // not in the shared array: neighbours would share a cache line
    const int x0 = tile % across * size;
    const int y0 = tile / across * size;
    for (int y = y0; y < std::min(y0 + size, image.height); ++y) {
      for (int x = x0; x < std::min(x0 + size, image.width); ++x) {
        const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(image.width) +
                           static_cast<std::uint64_t>(x);
        Rng rng(context.seed, context.iteration, pixel);
        ++count.samples;
        const Rgb value = estimate(x, y, rng, count, scratch);
        if (!is_finite(value)) [[unlikely]] {
          ++count.rejected;
          continue;
        }
        if (value.x < 0 || value.y < 0 || value.z < 0) ++count.negative;
        image.at(x, y) = value;
      }
    }
    counters[static_cast<std::size_t>(tile)] = count;
  });
  if (stopped) throw IterationStopped{};
  Counters sum;
  for (const Counters& c : counters) sum += c;
  return sum;
}

}  // namespace lacuna
