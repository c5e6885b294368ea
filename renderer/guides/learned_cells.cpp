#include "renderer/guides/learned_cells.h"

#include <cmath>

namespace lacuna {

namespace {

constexpr double leaf_share = 0.01;  // of a quadtree's energy in a leaf: rho of the paper
constexpr int deepest_directions = 20;

void learn(DirectionTree& tree, std::span<const FoundLight> batch) {
  for (const FoundLight& l : batch) tree.add(l.w, double(l.weight), true);
}
void learn(AimedLobes& lobes, std::span<const FoundLight> batch) { lobes.learn(batch); }

void next_round(DirectionTree& sampling, DirectionTree& building) {
  building.build();
  // Without samples in this round, the old tree stays.
  if (!building.empty()) sampling = std::move(building);
  building = sampling.refined(leaf_share, deepest_directions);
}
void next_round(AimedLobes& sampling, AimedLobes& building) {
  sampling = building;
  building.next_round();
}

}  // namespace

template <class Directions>
void LearnedCells<Directions>::accumulate(std::uint32_t cell, const GuidingSample& sample,
                                          float light, Accumulator& accumulator) {
  accumulator.vertices.push_back(cell);
  const float weight = light / sample.pdf.value;
  if (weight > 0 && std::isfinite(weight)) {
    accumulator.samples.push_back({cell, {sample.v.surface.x, sample.wi, sample.distance, weight}});
  }
}

template <class Directions>
bool LearnedCells<Directions>::update(std::span<const Accumulator* const> accumulators,
                                      const ThreadPool& pool, double iterations) {
  // By cell, each in the order of the accumulators: cells can then be filled in parallel.
  std::vector<std::size_t> first(cells_.size() + 1, 0);
  for (const Accumulator* a : accumulators) {
    for (const std::uint32_t c : a->vertices) ++cells_[c].vertices;
    for (const Found& s : a->samples) ++first[s.cell + 1];
  }
  for (std::size_t c = 0; c < cells_.size(); ++c) first[c + 1] += first[c];
  std::vector<FoundLight> sorted(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const Accumulator* a : accumulators) {
    for (const Found& s : a->samples) sorted[next[s.cell]++] = s.light;
  }
  pool.for_each(static_cast<int>(cells_.size()), [&](int i) {
    const auto c = static_cast<std::size_t>(i);
    learn(cells_[c].building, std::span(sorted).subspan(first[c], first[c + 1] - first[c]));
  });
  return rounds_.add(iterations);
}

template <class Directions>
void LearnedCells<Directions>::divide(std::size_t cell) {
  cells_[cell].vertices /= 2;
  Cell half = cells_[cell];
  cells_.push_back(std::move(half));
}

template <class Directions>
void LearnedCells<Directions>::next_round(const ThreadPool& pool) {
  pool.for_each(static_cast<int>(cells_.size()), [&](int i) {
    Cell& cell = cells_[static_cast<std::size_t>(i)];
    lacuna::next_round(cell.sampling, cell.building);
    cell.vertices = 0;
  });
  rounds_.next();
}

template <class Directions>
void LearnedCells<Directions>::save(ByteWriter& out) const {
  rounds_.save(out);
  out.put(static_cast<std::uint64_t>(cells_.size()));
  for (const Cell& c : cells_) {
    c.sampling.save(out);
    c.building.save(out);
    out.put(c.vertices);
  }
}

template <class Directions>
void LearnedCells<Directions>::load(ByteReader& in) {
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

template class LearnedCells<DirectionTree>;
template class LearnedCells<AimedLobes>;

}  // namespace lacuna
