#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/complex/cubical_complex.h"

namespace lacuna {

/// The constraint set W of Alg. 2: edges that thinning must not remove, and their vertices (without
/// them, curves would be removed from their ends). Few blocks contain any.
class KeptEdges {
 public:
  struct Block {
    Plane vertices = Plane::zero();
    std::array<Plane, 3> edges{Plane::zero(), Plane::zero(), Plane::zero()};  ///< by axis
  };

  /// Memory per block without kept edges.
  static constexpr std::uint64_t bytes_per_block = sizeof(std::uint32_t);

  explicit KeptEdges(const CubicalComplex& complex)
      : slots_(complex.block_count()),
        blocks_(1),
        strides_{1, complex.stride(1), complex.stride(2)} {}

  /// Adds the edges along `axis` at the set cells of one block.
  void add(std::size_t block, int axis, const Plane& edges) {
    Block& b = at(block);
    b.edges[static_cast<std::size_t>(axis)] |= edges;
    Plane far, over;
    ends(axis, edges, far, over);
    b.vertices |= edges | far;
    if (over.any()) {
      at(static_cast<std::size_t>(static_cast<std::ptrdiff_t>(block) +
                                  strides_[static_cast<std::size_t>(axis)]))
          .vertices |= over;
    }
  }
  /// The kept faces of a block; empty planes if there are none.
  const Block& of(std::size_t block) const { return blocks_[slots_[block]]; }
  /// Number of edges.
  std::size_t count() const {
    std::size_t n = 0;
    for (const Block& b : blocks_) {
      for (const Plane& p : b.edges) n += static_cast<std::size_t>(p.bits().count());
    }
    return n;
  }

 private:
  Block& at(std::size_t block) {
    if (slots_[block] == 0) {
      slots_[block] = static_cast<std::uint32_t>(blocks_.size());
      blocks_.emplace_back();
    }
    return blocks_[slots_[block]];
  }
  static void ends(int axis, const Plane& edges, Plane& far, Plane& over) {
    const Plane none = Plane::zero();
    switch (axis) {
      case 0:
        far = from_low<0>(edges, none), over = from_low<0>(none, edges);
        break;
      case 1:
        far = from_low<1>(edges, none), over = from_low<1>(none, edges);
        break;
      default:
        far = from_low<2>(edges, none), over = from_low<2>(none, edges);
    }
  }

  std::vector<std::uint32_t> slots_;  // 0: nothing kept there
  std::vector<Block> blocks_;
  std::array<std::ptrdiff_t, 3> strides_;
};

}  // namespace lacuna
