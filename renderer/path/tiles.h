#pragma once

#include <vector>

#include "renderer/path/contexts.h"
#include "renderer/path/eye_batch.h"
#include "renderer/path/splats.h"
#include "renderer/path/tile.h"

namespace lacuna {

/// Adds a contribution to a pixel. One that is not finite is dropped and counted: no such value may
/// enter a film.
inline void accumulate(Rgb& pixel, const Rgb& value, Counters& counters) {
  if (!is_finite(value)) [[unlikely]] {
    ++counters.rejected;
    return;
  }
  if (value.x < 0 || value.y < 0 || value.z < 0) ++counters.negative;
  pixel += value;
}

/// Calls `work(i, counters)` for i in [0, n) in parallel and returns the sum of the counters.
/// Throws IterationStopped when the context's stop() returns true.
template <class Work>
Counters for_each_part(const IterationContext& context, int n, Work&& work) {
  std::vector<Counters> counters(static_cast<std::size_t>(n));
  context.pool.for_each(n, [&](int i) {
    context.check_stop();
    Counters count;  // not in the shared array: neighbours would share a cache line
    work(i, count);
    counters[static_cast<std::size_t>(i)] = count;
  });
  Counters sum;
  for (const Counters& c : counters) sum += c;
  return sum;
}

/// Divides an image into square tiles.
class Tiling {
 public:
  /// `size`: pixels along a side; by default small enough to stop quickly and large enough to be
  /// coherent.
  explicit Tiling(const Image& image, int size = 32)
      : width_(image.width),
        height_(image.height),
        size_(size),
        across_((image.width + size - 1) / size) {}

  int tiles() const { return across_ * ((height_ + size_ - 1) / size_); }
  Tile tile(int i) const {
    const V2i first = V2i(i % across_, i / across_) * size_;
    return {first, V2i(std::min(size_, width_ - first.x), std::min(size_, height_ - first.y))};
  }

 private:
  int width_, height_, size_, across_;
};

/// Calls `render(tile, counters)` for all tiles of `image` in parallel (for_each_part()).
template <class Render>
Counters for_each_tile(const IterationContext& context, const Image& image, Render&& render) {
  const Tiling tiling(image);
  return for_each_part(context, tiling.tiles(),
                       [&](int i, Counters& counters) { render(tiling.tile(i), counters); });
}

/// The start of a pixel's sample: its stream of random numbers, and its camera ray.
struct CameraSample {
  Rng rng;
  Ray ray;

  CameraSample(const IterationContext& context, std::size_t pixel)
      : rng(context.path_numbers(pixel, Rng::Purpose::eye_path)),
        ray(context.camera.sample(column_row(pixel, context.camera.width()), rng.next2(), rng)) {}

 private:
  static V2i column_row(std::size_t pixel, int width) {
    const int i = static_cast<int>(pixel);
    return {i % width, i / width};
  }
};

static_assert(Tile::block_side * Tile::block_side == EyeBatch::size);

/// Starts a path for each pixel of a Tile::block(). Their walk may trace the camera rays together
/// (WalkLimits::packets). Throws IterationStopped: a tile of long paths takes minutes.
inline void start_paths(const IterationContext& context, const Image& image, const Tile& block,
                        EyeBatch& batch) {
  context.check_stop();
  batch.states.clear();
  for (int i = 0; i < block.pixels(); ++i) {
    const V2i at = block.pixel_of_block(i);
    const std::size_t pixel = image.index(at.x, at.y);
    const CameraSample sample(context, pixel);
    batch.start(context.camera, sample.rng, sample.ray, pixel);
  }
}

/// for_each_part() whose `work(i, counters, splats)` may also splat to any pixel. The splats are
/// added to `image` in the order of the parts, and `arrived(splat)` is called for each: by several
/// threads, each for pixels of its own.
template <class Work, class Arrived>
Counters for_each_splatting_part(const IterationContext& context, int n, Image& image, Work&& work,
                                 Arrived&& arrived) {
  constexpr int round = 128;  // parts whose splats are in memory together
  std::vector<BandedSplats> parts(static_cast<std::size_t>(std::min(n, round)));
  Counters sum;
  for (int first = 0; first < n; first += round) {
    const int some = std::min(round, n - first);
    sum += for_each_part(context, some, [&](int i, Counters& counters) {
      BandedSplats& part = parts[static_cast<std::size_t>(i)];
      part.clear();
      work(first + i, counters, part.splats());
      part.arrange(image.pixels.size());
    });
    const WorkSection section(context.pool, "splats");
    sum += for_each_part(context, int{BandedSplats::bands}, [&](int band, Counters& counters) {
      for (const BandedSplats& part : std::span(parts).first(std::size_t(some))) {
        part.for_each_in(std::size_t(band), [&](const Splat& s) {
          if (s.s != Splat::any_length) {
            context.light.add(s.pixel, s.s, s.matches, s.value * s.weight);
          }
          if (s.of_layers_only) return;
          accumulate(image.pixels[s.pixel], s.value * s.weight, counters);
          arrived(s);
        });
      }
    });
  }
  return sum;
}

}  // namespace lacuna
