#include "renderer/guides/learned_cells.h"

#include <algorithm>
#include <cmath>

namespace lacuna {

namespace {

constexpr double leaf_share =
    0.01;  // largest fraction of a quadtree's energy in a leaf: the paper's rho
constexpr int deepest_directions = 20;

void learn(DirectionTree& tree, std::span<const TrainingSample> samples) {
  for (const TrainingSample& s : samples) {
    const float energy = s.pdf > 0 ? s.radiance / s.pdf : 0.0F;
    if (energy > 0 && std::isfinite(energy)) tree.add(s.w, double(energy), true);
  }
}
void learn(AimedLobes& lobes, std::span<const TrainingSample> samples) { lobes.learn(samples); }

void next_round(DirectionTree& sampling, DirectionTree& building) {
  building.build();
  // Without samples in this round, keep the previous tree.
  if (!building.empty()) sampling = std::move(building);
  building = sampling.refined(leaf_share, deepest_directions);
}
void next_round(AimedLobes& sampling, AimedLobes& building) {
  sampling = building;
  building.next_round();
}

}  // namespace

template <class Directions>
LearnedCells<Directions>::LearnedCells(std::vector<Directions> first) {
  for (Directions& d : first) {
    Cell& cell = cells_.emplace_back();
    cell.building = d;
    cell.sampling = std::move(d);
  }
}

template <class Directions>
double LearnedCells<Directions>::most_vertices(int first) const {
  return double(first) * std::sqrt(rounds_.last_length());
}

template <class Directions>
bool LearnedCells<Directions>::update(const TrainingSamples& samples, const ThreadPool& pool) {
  pool.for_each(static_cast<int>(cells_.size()), [&](int i) {
    const auto c = static_cast<std::size_t>(i);
    const std::span<const TrainingSample> own = samples.of(c);
    cells_[c].vertices +=
        double(std::ranges::count_if(own, [](const auto& s) { return s.pdf > 0; }));
    learn(cells_[c].building, own);
  });
  return rounds_.add(samples.share());
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
