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

/// A rectangle of an image, rendered by one thread.
struct Tile {
  V2i first{0, 0};
  V2i size{0, 0};

  int pixels() const { return size.x * size.y; }
  V2i pixel(int i) const { return first + V2i(i % size.x, i / size.x); }
};

/// Calls `render(tile, counters)` for all tiles of `image` in parallel and adds up what they
/// counted. Throws IterationStopped if the context asks for it.
template <class Render>
Counters for_each_tile(const IterationContext& context, const Image& image, Render&& render) {
  constexpr int size = 32;  // pixels; small enough to stop quickly, large enough to be coherent
  const int across = (image.width + size - 1) / size;
  const int down = (image.height + size - 1) / size;
  std::vector<Counters> counters(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  std::atomic<bool> stopped{false};
  context.pool.for_each(across * down, [&](int i) {
    if (stopped || context.stop()) {
      stopped = true;
      return;
    }
    const V2i first = V2i(i % across, i / across) * size;
    const Tile tile{
        first, V2i(std::min(size, image.width - first.x), std::min(size, image.height - first.y))};
    Counters count;  // not in the shared array: neighbours would share a cache line
    render(tile, count);
    counters[static_cast<std::size_t>(i)] = count;
  });
  if (stopped) throw IterationStopped{};
  Counters sum;
  for (const Counters& c : counters) sum += c;
  return sum;
}

/// Where a sample of a pixel starts: its stream of random numbers, and its first ray.
struct CameraSample {
  Rng rng;
  Ray ray;

  CameraSample(const IterationContext& context, const Image& image, const V2i& pixel)
      : rng(context.seed, context.iteration, image.index(pixel.x, pixel.y)),
        ray(context.camera.sample(pixel, rng.next2())) {}
};

}  // namespace lacuna
