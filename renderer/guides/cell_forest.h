#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/storage/bytes.h"

namespace lacuna {

/// Subdivides the surfaces of each region of the empty space into cells: for each region a binary
/// tree over the positions and normals of path vertices. A cell is split in the dimension of
/// largest variance of its vertices, at their mean.
class CellForest {
 public:
  /// A position relative to the scale of the region, and a unit normal.
  using Key = std::array<float, 6>;
  /// Statistics of the vertices of a cell: their number, the sums of their keys and of the squares
  /// of these.
  struct Spread {
    double count = 0;
    std::array<double, 6> sum{}, square{};

    void add(const Key& key);
    void add(const Spread& other);
  };

  CellForest() = default;
  /// One cell per region, with the region's index.
  explicit CellForest(std::size_t regions);

  std::size_t cells() const { return cells_; }
  std::uint32_t cell(std::uint32_t region, const Key& key) const {
    std::uint32_t node = region;
    while (nodes_[node].low != 0) {
      const Node& n = nodes_[node];
      node = n.low + (key[n.axis] >= n.at ? 1 : 0);
    }
    return nodes_[node].cell;
  }

  /// Splits every cell with more than `most` vertices once, up to `limit` cells in total.
  /// `spreads`: of each cell. Calls `divided(cell)` after each split; the new cell has the index
  /// cells() - 1.
  void divide(std::span<const Spread> spreads, double most, std::size_t limit,
              const std::function<void(std::uint32_t)>& divided);

  void save(ByteWriter& out) const { out.put(nodes_); }
  /// Throws std::runtime_error unless the data is a forest for that number of regions.
  void load(ByteReader& in, std::size_t regions);

 private:
  struct Node {
    std::uint32_t low = 0;  ///< the first of two adjacent children; 0: a leaf
    std::uint32_t axis = 0;
    std::uint32_t cell = 0;
    float at = 0;
  };

  std::vector<Node> nodes_;
  std::size_t cells_ = 0;
};

}  // namespace lacuna
