#pragma once

#include <array>

#include "analysis/regions/forest_labels.h"

namespace lacuna {

/// Weights of regions at a point, normalised.
class RegionMixture {
 public:
  struct Share {
    std::uint32_t region;
    double weight;
  };

  const Share* begin() const { return shares_.data(); }
  const Share* end() const { return shares_.data() + count_; }

  /// Adds to the weight of `region`. At most eight different regions.
  void add(std::uint32_t region, double weight) {
    for (std::size_t i = 0; i < count_; ++i) {
      if (shares_[i].region == region) {
        shares_[i].weight += weight;
        return;
      }
    }
    shares_[count_++] = {region, weight};
  }
  void scale(double by) {
    for (std::size_t i = 0; i < count_; ++i) shares_[i].weight *= by;
  }

 private:
  std::array<Share, 8> shares_;
  std::size_t count_ = 0;
};

/// Interpolates between the distributions of neighbouring regions. Regions have sharp borders, at
/// which the variance would jump (Noel 2015, 10.4, describes these discontinuities as unsolved).
/// Within `width` of a border the distributions of both sides are mixed with continuous weights: a
/// trilinear interpolation of the labels at the corners of a lattice of cells of that width,
/// without corners outside all regions.
class RegionLattice {
 public:
  RegionLattice() = default;
  /// `label` is referenced, not copied; `width`: voxels, 0: no mixing.
  RegionLattice(const Grid3<std::uint32_t>& label, int width) : label_(&label), width_(width) {
    if (width == 0) return;
    // Includes cells that extend beyond the grid: every corner in the grid belongs to eight cells.
    only_ = Grid3<std::uint32_t>((label.size() - Imath::V3i(1)) / width + Imath::V3i(2));
    for (std::size_t i = 0; i < only_.count(); ++i) only_[i] = only_region(only_.voxel(i));
  }

  /// The mixture at `x`, voxels; `own`: the region of the voxel in front of the surface.
  RegionMixture mixture(const Imath::V3d& x, std::uint32_t own) const {
    Imath::V3i cell;
    Imath::V3d part;
    for (int a = 0; a < 3 && width_ > 0; ++a) {
      const double at = x[a] / width_, low = std::floor(at);
      cell[a] = static_cast<int>(low) + 1;
      part[a] = at - low;
    }
    const bool known = width_ > 0 && in_grid(cell, only_.size());
    const std::uint32_t only = known ? only_(cell) : own;
    if (only == several) return mixture(cell, part, own);
    RegionMixture alone;
    alone.add(only == no_region ? own : only, 1);
    return alone;
  }

 private:
  static constexpr std::uint32_t several = no_region - 1;

  static Imath::V3i corner(int k) { return {k & 1, k >> 1 & 1, k >> 2}; }
  /// The region at corner `k` of a cell.
  std::uint32_t at(const Imath::V3i& cell, int k) const {
    const Imath::V3i v = (cell - Imath::V3i(1) + corner(k)) * width_;
    return in_grid(v, label_->size()) ? (*label_)(v) : no_region;
  }
  /// The region if it is the same at all corners of a cell; `several`, or no_region.
  std::uint32_t only_region(const Imath::V3i& cell) const {
    std::uint32_t only = no_region;
    for (int k = 0; k < 8; ++k) {
      const std::uint32_t region = at(cell, k);
      if (region == no_region) continue;
      only = only == no_region || only == region ? region : several;
    }
    return only;
  }

  RegionMixture mixture(const Imath::V3i& cell, const Imath::V3d& part, std::uint32_t own) const {
    RegionMixture mixed;
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= corner(k)[a] != 0 ? part[a] : 1 - part[a];
      const std::uint32_t region = weight > 0 ? at(cell, k) : no_region;
      if (region == no_region) continue;
      mixed.add(region, weight);
      sum += weight;
    }
    if (sum > 0) {
      mixed.scale(1 / sum);
    } else {
      mixed.add(own, 1);
    }
    return mixed;
  }

  const Grid3<std::uint32_t>* label_ = nullptr;
  int width_ = 0;
  Grid3<std::uint32_t> only_;  // of each cell
};

}  // namespace lacuna
