#pragma once

#include <atomic>
#include <vector>

#include "renderer/integrators/integrator.h"

namespace lacuna {

/// Adds a contribution to a pixel. One that is not finite is dropped and counted: nothing
/// non-finite enters a film.
inline void accumulate(Rgb& pixel, const Rgb& value, Counters& counters) {
  if (!is_finite(value)) [[unlikely]] {
    ++counters.rejected;
    return;
  }
  if (value.x < 0 || value.y < 0 || value.z < 0) ++counters.negative;
  pixel += value;
}

/// Estimates every pixel once, tile by tile in parallel. `estimate(x, y, rng, counters, scratch)`
/// gives one sample of pixel (x, y); `rng` is its own stream. `make_scratch()` makes what the
/// pixels of a tile share; `finish(scratch, counters)` is called after its last pixel.
template <class MakeScratch, class Estimate, class Finish>
Counters for_each_pixel(const IterationContext& context, Image& image, MakeScratch&& make_scratch,
                        Estimate&& estimate, Finish&& finish) {
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
        Rng rng(context.seed, context.iteration, image.index(x, y));
        ++count.samples;
        accumulate(image.at(x, y), estimate(x, y, rng, count, scratch), count);
      }
    }
    finish(scratch, count);
    counters[static_cast<std::size_t>(tile)] = count;
  });
  if (stopped) throw IterationStopped{};
  Counters sum;
  for (const Counters& c : counters) sum += c;
  return sum;
}

}  // namespace lacuna
