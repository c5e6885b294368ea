#pragma once

#include <array>

#include "analysis/regions/forest_labels.h"

namespace lacuna {

/// Which regions' ways of drawing directions are mixed at a point, and how. Regions have sharp
/// borders, at which the variance of what is drawn would jump (Noel 2015, 10.4: discontinuities
/// that the thesis leaves unsolved); so within `width` of a border both sides' are mixed, by
/// weights that change continuously from place to place: the labels at the corners of a lattice of
/// cells of that width, interpolated, those outside all regions left out.
class RegionMixture {
 public:
  struct Share {
    std::uint32_t region;
    double weight;
  };

  /// At `x`, in voxels, in front of which lies voxel `own` of a region. `width` 0: its alone.
  RegionMixture(const Grid3<std::uint32_t>& label, const Imath::V3d& x, std::uint32_t own,
                int width) {
    double sum = 0;
    if (width > 0) {
      const Imath::V3d at = x / width;
      const Imath::V3d cell(std::floor(at.x), std::floor(at.y), std::floor(at.z));
      for (int corner = 0; corner < 8; ++corner) {
        double weight = 1;
        Imath::V3i v;
        for (int a = 0; a < 3; ++a) {
          const bool high = (corner >> a & 1) != 0;
          const double part = at[a] - cell[a];
          weight *= high ? part : 1 - part;
          v[a] = static_cast<int>((cell[a] + (high ? 1 : 0)) * width);
        }
        if (!(weight > 0) || !in_grid(v, label.size()) || label(v) == no_region) continue;
        add(label(v), weight);
        sum += weight;
      }
    }
    if (sum == 0) {
      add(label[own], 1);
      return;
    }
    for (std::size_t i = 0; i < count_; ++i) shares_[i].weight /= sum;
  }

  const Share* begin() const { return shares_.data(); }
  const Share* end() const { return shares_.data() + count_; }

 private:
  void add(std::uint32_t region, double weight) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (shares_[i].region == region) {
        shares_[i].weight += weight;
        return;
      }
    }
    shares_[count_++] = {region, weight};
  }

  std::array<Share, 8> shares_;
  std::size_t count_ = 0;
};

}  // namespace lacuna
