#include "renderer/guides/learned_cells.h"

#include <cmath>

namespace lacuna {

namespace {

constexpr double leaf_share = 0.01;  // of a quadtree's energy in a leaf: rho of the paper
constexpr int deepest_directions = 20;

}  // namespace

void LearnedCells::accumulate(std::uint32_t cell, const V3f& w, float energy, Pdf<SolidAngle> p,
                              Accumulator& accumulator) {
  ++accumulator.vertices[cell];
  const float over_density = energy / p.value;
  if (over_density > 0 && std::isfinite(over_density)) {
    accumulator.samples.push_back({cell, w, over_density});
  }
}

bool LearnedCells::update(std::span<const Accumulator* const> accumulators, const ThreadPool& pool,
                          double iterations) {
  // By cell, each in the order of the accumulators: cells can then be filled in parallel.
  std::vector<std::size_t> first(cells_.size() + 1, 0);
  for (const Accumulator* a : accumulators) {
    for (std::size_t c = 0; c < cells_.size(); ++c) cells_[c].vertices += a->vertices[c];
    for (const EnergySample& s : a->samples) ++first[s.cell + 1];
  }
  for (std::size_t c = 0; c < cells_.size(); ++c) first[c + 1] += first[c];
  std::vector<const EnergySample*> sorted(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const Accumulator* a : accumulators) {
    for (const EnergySample& s : a->samples) sorted[next[s.cell]++] = &s;
  }
  pool.for_each(static_cast<int>(cells_.size()), [&](int i) {
    const auto c = static_cast<std::size_t>(i);
    for (std::size_t k = first[c]; k < first[c + 1]; ++k) {
      cells_[c].building.add(sorted[k]->w, double(sorted[k]->energy), true);
    }
  });
  return rounds_.add(iterations);
}

void LearnedCells::divide(std::size_t cell) {
  cells_[cell].vertices /= 2;
  Cell half = cells_[cell];
  cells_.push_back(std::move(half));
}

void LearnedCells::next_round(const ThreadPool& pool) {
  pool.for_each(static_cast<int>(cells_.size()), [&](int i) {
    Cell& cell = cells_[static_cast<std::size_t>(i)];
    cell.building.build();
    // Without samples in this round, the old tree stays.
    if (!cell.building.empty()) cell.sampling = std::move(cell.building);
    cell.building = cell.sampling.refined(leaf_share, deepest_directions);
    cell.vertices = 0;
  });
  rounds_.next();
}

void LearnedCells::save(ByteWriter& out) const {
  rounds_.save(out);
  out.put(static_cast<std::uint64_t>(cells_.size()));
  for (const Cell& c : cells_) {
    c.sampling.save(out);
    c.building.save(out);
    out.put(c.vertices);
  }
}

void LearnedCells::load(ByteReader& in) {
  LearningRounds rounds;
  rounds.load(in);
  std::vector<Cell> cells(in.get_length(sizeof(std::uint64_t)));
  for (Cell& c : cells) {
    c.sampling.load(in);
    c.building.load(in);
    c.vertices = in.get<double>();
  }
  rounds_ = rounds;
  cells_ = std::move(cells);
}

std::size_t LearnedCells::direction_nodes() const {
  std::size_t nodes = 0;
  for (const Cell& c : cells_) nodes += c.sampling.nodes();
  return nodes;
}

}  // namespace lacuna
