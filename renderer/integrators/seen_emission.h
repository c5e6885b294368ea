#pragma once

#include <vector>

#include "renderer/film/image.h"
#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"

namespace lacuna {

/// The emission that a camera sees directly: paths of one edge. Most pixels see one value, and one
/// sample is exact there; those on the border of an emitter, where most of the variance is, take
/// many.
class SeenEmission {
 public:
  /// Finds the pixels that see several values.
  void prepare(const PrepareContext& context);
  /// Adds an unbiased estimate to `image`, the film that was prepared or fewer pixels of the same
  /// view: one sample of a pixel that sees one value, `samples` or a few more, stratified, of the
  /// others.
  Counters add(const IterationContext& context, double samples, Image& image) const;

  /// Number of pixels that see several values.
  std::size_t uneven_pixels() const;

 private:
  /// Whether a pixel of `image` covers one that sees several values.
  bool is_uneven(const Image& image, const V2i& pixel) const;

  std::vector<char> uneven_;  // of each pixel; empty where nothing emits
  int width_ = 0, height_ = 0;
};

}  // namespace lacuna
