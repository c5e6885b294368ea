#include "renderer/connections/cell_statistics.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace lacuna {

void CellStatistics::add(std::span<const Accumulator> accumulators) {
  tiles_.resize(std::max(tiles_.size(), accumulators.size()));
  for (std::size_t i = 0; i < accumulators.size(); ++i) {
    const Accumulator& t = accumulators[i];
    for (const Accumulator::Visited& visited : t.visited_) {
      Cell& sum = cells_[visited.cell];
      sum.visits += visited.sums.visits;
      for (std::size_t k = 0; k < lengths; ++k) {
        sum.attempts[k] += visited.sums.attempts[k];
        sum.squares[k] += visited.sums.squares[k];
      }
    }
    tiles_[i].gathered += t.gathered_;
    tiles_[i].paths += t.paths_;
  }
  update_expected();
}

void CellStatistics::update_expected() {
  expected_.assign(cells_.size() * lengths, std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    for (std::size_t k = 0; k < lengths; ++k) {
      const double attempts = static_cast<double>(cells_[c].attempts[k]);
      if (cells_[c].attempts[k] < min_attempts) continue;
      expected_[c * lengths + k] = std::sqrt(cells_[c].squares[k] / attempts);
    }
  }
}

void CellStatistics::save(ByteWriter& out) const {
  out.put(cells_);
  out.put(tiles_);
}

void CellStatistics::load(ByteReader& in) {
  std::vector<Cell> cells = in.get_vector<Cell>();
  if (cells.size() != cells_.size()) {
    throw std::runtime_error("saved statistics of connections belong to another skeleton");
  }
  cells_ = std::move(cells);
  tiles_ = in.get_vector<TileSums>();
  update_expected();
}

}  // namespace lacuna
