#include "renderer/integrators/seen_emission.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/path/tiles.h"

namespace lacuna {
namespace {

/// Emission is one value where it differs by less than this part of the largest.
constexpr float even = 0.01F;

Rgb emission_along(const Scene& scene, const Ray& ray) {
  Hit hit;
  return scene.rays().intersect(ray, hit) ? scene.emitted(scene.surface(hit), -ray.d)
                                          : scene.emitters().background(ray.d);
}

/// Calls `at(u)` for a point in each cell of a grid of `side` x `side` over [0, 1)^2.
template <class At>
void stratified(int side, Rng& rng, At&& at) {
  const auto n = static_cast<float>(side);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const V2f cell(static_cast<float>(x), static_cast<float>(y));
      at((cell + rng.next2()) / n);
    }
  }
}

/// Of the luminances that are added.
struct Range {
  float low = std::numeric_limits<float>::infinity(), high = 0;

  void add(const Range& r) {
    low = std::min(low, r.low);
    high = std::max(high, r.high);
  }
};

}  // namespace

void SeenEmission::prepare(const PrepareContext& context) {
  uneven_.clear();
  if (context.scene.emitters().empty()) return;
  const Camera& camera = context.camera;
  const int width = width_ = camera.width(), height = height_ = camera.height();
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  };
  std::vector<Range> seen(index(0, height));
  context.pool.for_each(height, [&](int y) {
    context.pool.check_stop();
    for (int x = 0; x < width; ++x) {
      Rng rng(0, 0, index(x, y), Rng::Purpose::integrator);
      stratified(2, rng, [&](const V2f& u) {
        const float l = luminance(emission_along(context.scene, camera.sample({x, y}, u)));
        seen[index(x, y)].add({l, l});
      });
    }
  });
  uneven_.resize(seen.size());
  context.pool.for_each(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      Range around;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          around.add(seen[index(u, v)]);
        }
      }
      uneven_[index(x, y)] = around.high - around.low > even * around.high ? 1 : 0;
    }
  });
}

bool SeenEmission::is_uneven(const Image& image, const V2i& pixel) const {
  const auto first = [](int at, int all, int of) { return int(std::int64_t(at) * all / of); };
  const auto end = [&](int at, int all, int of) {
    return std::max(first(at, all, of) + 1, first(at + 1, all, of));
  };
  for (int y = first(pixel.y, height_, image.height); y < end(pixel.y, height_, image.height);
       ++y) {
    for (int x = first(pixel.x, width_, image.width); x < end(pixel.x, width_, image.width); ++x) {
      if (uneven_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] != 0) return true;
    }
  }
  return false;
}

Counters SeenEmission::add(const IterationContext& context, double samples, Image& image) const {
  if (uneven_.empty()) return {};
  const int side = static_cast<int>(std::ceil(std::sqrt(samples)));
  return for_each_tile(context, image, [&](const Tile& tile, Counters& counters) {
    for (int i = 0; i < tile.pixels(); ++i) {
      const V2i pixel = tile.pixel(i);
      const std::size_t index = image.index(pixel.x, pixel.y);
      Rng rng(context.seed, context.iteration, index);
      Rgb sum(0, 0, 0);
      float n = 0;
      stratified(is_uneven(image, pixel) ? side : 1, rng, [&](const V2f& u) {
        sum += emission_along(context.scene, context.camera.sample(pixel, u));
        ++n;
      });
      counters.samples += static_cast<std::uint64_t>(n);
      counters.rays += static_cast<std::uint64_t>(n);
      accumulate(image.pixels[index], sum / n, counters);
    }
  });
}

std::size_t SeenEmission::uneven_pixels() const {
  return static_cast<std::size_t>(std::count(uneven_.begin(), uneven_.end(), 1));
}

}  // namespace lacuna
