#pragma once

#include <vector>

#include "renderer/film/image.h"
#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"
#include "renderer/path/tile.h"

namespace lacuna {

/// The emission that a camera sees directly: paths of one edge. Most pixels see a single value, for
/// which one sample is exact. Pixels on the border of an emitter cause most of the variance of a
/// simple scene: they get many camera rays, which are the cheapest rays.
class SeenEmission {
 public:
  /// Finds the pixels that see several values.
  void prepare(const PrepareContext& context);
  /// Adds an unbiased estimate to `image`, which has the size of the prepared camera's film or
  /// fewer pixels of the same view: one sample for a pixel that sees one value,
  /// ceil(sqrt(samples))^2 stratified samples for the others.
  Counters add(const IterationContext& context, double samples, Image& image) const;

  /// Number of additional camera rays for `pixel`: a power of two, at most 16, in proportion to the
  /// range of the values that it sees; for all pixels together at most half of the number of
  /// pixels. 0: none, the camera ray of the pixel's path is enough.
  int rays(std::size_t pixel) const { return worth_any_ ? rays_of(pixel) : 0; }
  /// For each pixel of `block` with rays() > 0, traces them and calls `add(pixel, value)` with an
  /// unbiased estimate of the emission that it sees. The pixel's path must then leave it out.
  template <class Add>
  void add(const IterationContext& context, const Tile& block, Counters& counters,
           Add&& add) const {
    if (!worth_any_) return;
    for (int i = 0; i < block.pixels(); ++i) {
      const V2i at = block.pixel(i);
      const std::size_t pixel =
          std::size_t(at.y) * std::size_t(context.camera.width()) + static_cast<std::size_t>(at.x);
      const int n = rays_of(pixel);
      if (n > 0) add(pixel, mean(context, pixel, n, counters));
    }
  }

  /// Number of pixels that see several values.
  std::size_t uneven_pixels() const;

 private:
  /// `even`: the pixel sees one value. `one`: several, but it has no additional rays. Else: rays().
  using Known = std::uint8_t;
  static constexpr Known even = 0, one = 1;

  void share_rays(const std::vector<float>& apart);
  int rays_of(std::size_t pixel) const { return known_[pixel] > one ? known_[pixel] : 0; }
  static Rgb mean(const IterationContext& context, std::size_t pixel, int n, Counters& counters);

  std::vector<Known> known_;  // of each pixel; empty where nothing emits
  bool worth_any_ = false;    // rays() > 0 for some pixel
};

}  // namespace lacuna
