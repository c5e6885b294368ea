#pragma once

#include "renderer/view_maps/view_rendering.h"

namespace lacuna {

/// The maps of all view nodes as rendered, without fusion (Kol et al. 2018, 3.2.5). A query reads
/// one texel of every map between the root and a leaf. The result has the bits of the fused map.
class UnfusedMaps {
 public:
  /// `maps`: ViewRendering::map_floats() distances of each node from index `first`.
  UnfusedMaps(const ViewRendering& rendering, const ViewTree& views, std::uint32_t first,
              std::vector<float> maps);

  /// The distance, scene units, of a leaf's texel; infinite if it is empty. Adds the number of
  /// texels that were read to `read`.
  float distance(std::uint32_t leaf, int texel, std::uint64_t& read) const;

 private:
  static constexpr std::uint32_t none = 0xffffffff;
  /// A node that has a map.
  struct Node {
    std::uint32_t parent = none;  // the next node above that has a map
    V3f step;                     // from this node's centre to the parent's, in the grid
  };
  std::uint32_t first_, first_leaf_;
  std::size_t floats_;
  float unit_;
  std::vector<V3f> directions_;  // of the texels
  std::vector<Node> nodes_;      // from first_
  std::vector<float> maps_;
};

}  // namespace lacuna
