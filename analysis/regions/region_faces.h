#pragma once

#include <array>
#include <cstdint>

#include "analysis/regions/forest_labels.h"
#include "analysis/regions/voxel_face.h"

namespace lacuna {

/// Enumerates the faces of a plane's voxels that leave a region, for portals and borders.
class RegionFaces {
 public:
  explicit RegionFaces(const Grid3<std::uint32_t>& label) : label_(label), size_(label.size()) {}

  /// Calls visit(face, region, beyond) for every face of every voxel of a region in plane z whose
  /// other side, `beyond`, is another region or none (no_region: scene, or outside the grid). By
  /// voxel, then by side.
  template <class Visit>
  void for_each(int z, Visit&& visit) const {
    for (int y = 0; y < size_.y; ++y) {
      const bool at_rim = y == 0 || z == 0 || y == size_.y - 1 || z == size_.z - 1;
      for (int x = 0; x < size_.x;) {
        if (!at_rim && x > 0 && x + chunk < size_.x && is_even(x, y, z)) {
          x += chunk;
        } else {
          visit_voxel({x, y, z}, visit);
          ++x;
        }
      }
    }
  }

 private:
  static constexpr int chunk = 16;

  /// Whether `chunk` voxels along x and all their neighbours have one label, as most have.
  bool is_even(int x, int y, int z) const {
    const std::uint32_t *row = label_.row(y, z) + x, *low_y = label_.row(y - 1, z) + x,
                        *high_y = label_.row(y + 1, z) + x, *low_z = label_.row(y, z - 1) + x,
                        *high_z = label_.row(y, z + 1) + x;
    const std::uint32_t same = row[-1];
    std::uint32_t other = 0;
    for (int k = 0; k < chunk; ++k)
      other |= (row[k] ^ same) | (low_y[k] ^ same) | (high_y[k] ^ same) | (low_z[k] ^ same) |
               (high_z[k] ^ same);
    return (other | (row[chunk] ^ same)) == 0;
  }

  template <class Visit>
  void visit_voxel(Imath::V3i v, Visit&& visit) const {
    const std::size_t i = label_.index(v);
    const std::uint32_t region = label_[i];
    if (region == no_region) return;
    const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(size_.x),
                                            label_.index(0, 0, 1)};
    for (std::uint8_t side = 0; side < 6; ++side) {
      const VoxelFace face{static_cast<std::uint32_t>(i), side};
      const int a = face.axis();
      const std::size_t step = stride[static_cast<std::size_t>(a)];
      const bool at_rim = v[a] == (face.positive() ? size_[a] - 1 : 0);
      const std::uint32_t beyond =
          at_rim ? no_region : label_[face.positive() ? i + step : i - step];
      if (beyond != region) visit(face, region, beyond);
    }
  }

  const Grid3<std::uint32_t>& label_;
  Imath::V3i size_;
};

}  // namespace lacuna
