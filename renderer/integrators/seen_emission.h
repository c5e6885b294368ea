#pragma once

#include <vector>

#include "renderer/film/image.h"
#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"
#include "renderer/path/tile.h"

namespace lacuna {

/// The emission that a camera sees directly: paths of one edge. Most pixels see one value, and one
/// sample is exact there; those on the border of an emitter, where most of the variance of a simple
/// scene is, are worth many camera rays, which are the cheapest of all.
class SeenEmission {
 public:
  /// Finds the pixels that see several values.
  void prepare(const PrepareContext& context);
  /// Adds an unbiased estimate to `image`, the film that was prepared or fewer pixels of the same
  /// view: one sample of a pixel that sees one value, `samples` or a few more, stratified, of the
  /// others.
  Counters add(const IterationContext& context, double samples, Image& image) const;

  /// Camera rays that `pixel` is worth beside paths that are traced from it: a power of two of at
  /// most 16, in proportion to how far the values lie apart, and at most half of the number of
  /// pixels for all of them. 0: the path's own is enough.
  int rays(std::size_t pixel) const { return worth_any_ ? rays_of(pixel) : 0; }
  /// Traces rays() of each pixel of `block` and calls `add(pixel, value)` with an unbiased estimate
  /// of the emission that it sees, if there are any. Then the paths leave it out.
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
  /// What is known of a pixel. `even`: it sees one value; `one`: several, which are not worth rays
  /// of their own; others are the number of rays.
  using Known = std::uint8_t;
  static constexpr Known even = 0, one = 1;

  void share_rays(const std::vector<float>& apart);
  int rays_of(std::size_t pixel) const { return known_[pixel] > one ? known_[pixel] : 0; }
  static Rgb mean(const IterationContext& context, std::size_t pixel, int n, Counters& counters);

  std::vector<Known> known_;  // of each pixel; empty where nothing emits
  bool worth_any_ = false;    // some pixel is worth rays of its own
};

}  // namespace lacuna
