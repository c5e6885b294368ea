#pragma once

#include <array>
#include <vector>

#include "renderer/film/crop.h"

namespace lacuna {

/// Selects the crops of a picture in which the errors of methods differ most. Pictures are added
/// one after the other.
class CropSelection {
 public:
  /// Of crop_grid() with this side, in pixels.
  CropSelection(const std::array<int, 2>& resolution, int side);

  /// Adds a method's picture, of three values for each pixel. `reference`: likewise, the same for
  /// all; empty: the methods are compared with the first.
  void add(const std::vector<double>& picture, const std::vector<double>& reference);

  /// At most `count` squares without common pixels, in which the methods' relative errors differ
  /// most, or that of a single method is largest; the middle if no errors are known.
  std::vector<PixelRect> choose(std::size_t count) const;

 private:
  std::array<int, 2> resolution_;
  std::vector<PixelRect> grid_;
  std::vector<std::vector<double>> errors_;  // of each method, by square
  std::vector<double> first_;                // the first picture, without a reference
};

}  // namespace lacuna
