#include "renderer/guides/cell_forest.h"

#include <stdexcept>

namespace lacuna {

void CellForest::Spread::add(const Key& key) {
  ++count;
  for (std::size_t a = 0; a < key.size(); ++a) {
    sum[a] += double(key[a]);
    square[a] += double(key[a]) * double(key[a]);
  }
}

void CellForest::Spread::add(const Spread& other) {
  count += other.count;
  for (std::size_t a = 0; a < sum.size(); ++a) {
    sum[a] += other.sum[a];
    square[a] += other.square[a];
  }
}

CellForest::CellForest(std::size_t regions) : nodes_(regions), cells_(regions) {
  for (std::size_t r = 0; r < regions; ++r) nodes_[r].cell = static_cast<std::uint32_t>(r);
}

void CellForest::divide(std::span<const Spread> spreads, double most, std::size_t limit,
                        const std::function<void(std::uint32_t)>& divided) {
  const std::size_t all = nodes_.size();
  for (std::size_t n = 0; n < all && cells_ < limit; ++n) {
    if (nodes_[n].low != 0) continue;
    const std::uint32_t cell = nodes_[n].cell;
    const Spread& spread = spreads[cell];
    if (!(spread.count > most)) continue;
    std::uint32_t axis = 0;
    double widest = 0;
    for (std::uint32_t a = 0; a < spread.sum.size(); ++a) {
      const double mean = spread.sum[a] / spread.count;
      const double variance = spread.square[a] / spread.count - mean * mean;
      if (variance > widest) {
        widest = variance;
        axis = a;
      }
    }
    const double mean = spread.sum[axis] / spread.count;
    // A smaller variance is a rounding error: all vertices have the same position.
    if (!(widest > 1e-12 * (1 + mean * mean))) continue;
    const auto low = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({0, 0, cell, 0});
    nodes_.push_back({0, 0, static_cast<std::uint32_t>(cells_++), 0});
    nodes_[n] = {low, axis, 0, static_cast<float>(mean)};
    divided(cell);
  }
}

void CellForest::load(ByteReader& in, std::size_t regions) {
  std::vector<Node> nodes = in.get_vector<Node>();
  bool good = nodes.size() >= regions && (nodes.size() - regions) % 2 == 0;
  const std::size_t cells = regions + (good ? (nodes.size() - regions) / 2 : 0);
  for (std::size_t i = 0; i < nodes.size() && good; ++i) {
    const Node& n = nodes[i];
    // Children follow their parents, so there are no cycles.
    good = n.low == 0 ? n.cell < cells
                      : n.low > i && n.low + std::size_t{1} < nodes.size() && n.axis < 6;
  }
  if (!good) throw std::runtime_error("saved cells belong to another scene");
  nodes_ = std::move(nodes);
  cells_ = cells;
}

}  // namespace lacuna
