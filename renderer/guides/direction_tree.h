#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/storage/bytes.h"
#include "renderer/core/density.h"
#include "renderer/core/rng.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// A direction as a point of the unit square, by the cylinder's map: z and the angle around it.
/// Area-preserving up to the factor 4 pi.
V2f to_square(const V3f& w);
V3f from_square(const V2f& p);

/// A quadtree over the square of directions, with the energy that came from each part (Mueller et
/// al. 2017, section 3).
class DirectionTree {
 public:
  /// One quarter of the square in each node at first.
  DirectionTree() : nodes_(1) {}

  /// Adds `energy` >= 0 that came along unit `w`; with `filter`, spread over a square of the size
  /// of its leaf around `w`, so that noise is smoothed where the tree is coarse (Mueller 2019, box
  /// filter).
  void add(const V3f& w, double energy, bool filter);
  /// Sums up what was added.
  void build();
  double energy() const { return sum(nodes_[0]); }
  /// Nothing can be drawn.
  bool empty() const { return !(energy() > 0); }

  /// Only where it is not empty.
  V3f sample(Rng& rng) const;
  Pdf<SolidAngle> pdf(const V3f& w) const;

  /// The same tree without energy, with leaves divided that hold more than `share` of it, and
  /// joined where they do not; at most `depth` levels.
  DirectionTree refined(double share, int depth) const;

  std::size_t nodes() const { return nodes_.size(); }
  void save(ByteWriter& out) const { out.put(nodes_); }
  /// Throws std::runtime_error if it is no tree.
  void load(ByteReader& in);

 private:
  struct Node {
    std::array<float, 4> energy{};
    std::array<std::uint32_t, 4> child{};  // 0: a leaf
  };
  static double sum(const Node& n) {
    return double(n.energy[0]) + double(n.energy[1]) + double(n.energy[2]) + double(n.energy[3]);
  }
  /// Which quarter `p` lies in, and `p` within it.
  static std::size_t quarter(V2f& p);
  double leaf_size(V2f p) const;
  void spread(std::uint32_t node, const V2f& low, float size, const V2f& from, const V2f& to,
              double density);
  double build(std::uint32_t node);

  std::vector<Node> nodes_;
};

}  // namespace lacuna
