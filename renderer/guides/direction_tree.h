#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/core/density.h"
#include "renderer/core/rng.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// The cylindrical map of a direction to the unit square: z and the azimuth. It preserves areas up
/// to the factor 4 pi.
V2f to_square(const V3f& w);
V3f from_square(const V2f& p);

/// A quadtree over the square of directions that stores the energy from each quadrant (Mueller et
/// al. 2017, section 3).
class DirectionTree {
 public:
  /// A tree of one node, whose four leaves are the quadrants of the square.
  DirectionTree() : nodes_(1) {}

  /// Adds `energy` >= 0 from unit direction `w`. With `filter`, distributes it over a square around
  /// `w` of the size of its leaf, which smooths noise where the tree is coarse (Mueller 2019, box
  /// filter).
  void add(const V3f& w, double energy, bool filter);
  /// Sums the energies of the leaves up to the root; call after the last add().
  void build();
  double energy() const { return sum(nodes_[0]); }
  /// Whether nothing can be sampled.
  bool empty() const { return !(energy() > 0); }

  /// Samples by a piecewise linear map of the unit square to itself: the first coordinate selects a
  /// quadrant's column, the second its row. Requires !empty().
  V3f sample(const Rng::FinePoint& u) const;
  V3f sample(Rng& rng) const { return sample(rng.next_fine_point()); }
  Pdf<SolidAngle> pdf(const V3f& w) const;

  /// The tree of the next round, without energy: nodes with more than the fraction `share` of all
  /// energy are split, the others become leaves; at most `depth` levels.
  DirectionTree refined(double share, int depth) const;

  std::size_t nodes() const { return nodes_.size(); }
  void save(ByteWriter& out) const { out.put(nodes_); }
  /// Throws std::runtime_error if the data is not a tree.
  void load(ByteReader& in);

 private:
  struct Node {
    std::array<float, 4> energy{};
    std::array<std::uint32_t, 4> child{};  // 0: a leaf
  };
  static double sum(const Node& n) {
    return double(n.energy[0]) + double(n.energy[1]) + double(n.energy[2]) + double(n.energy[3]);
  }
  /// Returns the quadrant that contains `p` and makes `p` relative to it.
  static std::size_t quarter(V2f& p);
  double leaf_size(V2f p) const;
  struct Rectangle {
    V2f low, high;
  };
  void spread(std::uint32_t node, const V2f& low, float size, const Rectangle& area,
              double density);
  double build(std::uint32_t node);

  std::vector<Node> nodes_;
};

}  // namespace lacuna
