#pragma once

#include <array>
#include <vector>

#include "renderer/images/texture.h"

namespace lacuna {

/// Means of a texture's colours over triangles of texture coordinates, to estimate the power of
/// emitters. A pyramid of sums over squares of texels, built once per texture; a triangle reads the
/// level at which it covers a few hundred squares.
class TextureMeans {
 public:
  /// Keeps a pointer to `texture`, which must be decoded.
  explicit TextureMeans(const Texture& texture);

  struct Mean {
    V3d rgb{0, 0, 0};  ///< linear
    int cells = 0;     ///< texels or sums read: at most `most_cells`
  };
  /// An estimate of the mean of Texture::lookup() over the triangle with the corners `uv`, which
  /// may be anywhere and of any size. A channel is 0 only if lookup() is 0 everywhere on the
  /// triangle. `largest`: the largest number used to compute `uv`, which bounds their rounding
  /// errors.
  Mean over(const std::array<V2f, 3>& uv, float largest) const;
  /// The mean over all texels.
  V3d whole() const;

  static constexpr int most_cells = 512;

 private:
  /// Sums over squares of 2^shift x 2^shift texels, clipped at the image's border.
  struct Level {
    int shift, width, height;
    std::vector<Rgb> sums;
  };
  struct Cell {
    int x, y;
  };
  /// The mean of a cell of `level`; null: the value of a texel.
  V3d mean(const Level* level, Cell cell) const;

  const Texture* texture_;
  std::vector<Level> levels_;  // the last one is a single cell
};

}  // namespace lacuna
