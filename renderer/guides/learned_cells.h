#pragma once

#include <cmath>

#include "renderer/guides/direction_tree.h"
#include "renderer/guides/guiding_distribution.h"
#include "renderer/guides/learning_rounds.h"

namespace lacuna {

/// The light that paths found at the vertices of each cell of a guide, as quadtrees of directions
/// (Mueller, Gross and Novak 2017). It is learned in LearningRounds: a round
/// samples the directions of the round before, and builds those of the next one.
class LearnedCells {
 public:
  static constexpr std::size_t most = std::size_t{1} << 18;  ///< cells that a guide may divide into

  LearnedCells() = default;
  explicit LearnedCells(std::size_t cells) : cells_(cells) {}

  std::size_t size() const { return cells_.size(); }
  /// What the last round found; empty where it found nothing.
  const DirectionTree& tree(std::size_t cell) const { return cells_[cell].sampling; }
  /// Vertices of paths in this round.
  double vertices(std::size_t cell) const { return cells_[cell].vertices; }
  /// Vertices above which a cell is divided at the end of this round, where `first` are of a round
  /// of one iteration: the paper's c sqrt(2^k) grows with the number of samples.
  double most_vertices(int first) const { return double(first) * std::sqrt(rounds_.length()); }
  /// Rounds that have ended.
  std::uint64_t rounds() const { return rounds_.ended(); }

  /// The light that arrived at a vertex.
  struct EnergySample {
    std::uint32_t cell;
    V3f w;
    float energy;  ///< over the density with which `w` was sampled
  };
  /// The samples of one part of an iteration.
  struct Accumulator {
    explicit Accumulator(std::size_t cells) : vertices(cells, 0) {}
    std::vector<std::uint32_t> vertices;  // of each cell
    std::vector<EnergySample> samples;
  };
  Accumulator accumulator() const { return Accumulator(cells_.size()); }
  /// A vertex of `cell` < size() from which `energy` was found in direction `w`, which was sampled
  /// with density `p`.
  static void accumulate(std::uint32_t cell, const V3f& w, float energy, Pdf<SolidAngle> p,
                         Accumulator& accumulator);
  /// Adds the samples of `iterations`, in the order of their parts. True: a round has ended. Cells
  /// may then be divided, and next_round() must be called.
  bool update(std::span<const Accumulator* const> accumulators, const ThreadPool& pool,
              double iterations);
  /// Adds a cell that starts as a copy of `cell`; each has half of its vertices.
  void divide(std::size_t cell);
  void next_round(const ThreadPool& pool);

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error if the data is not valid.
  void load(ByteReader& in);
  /// Nodes of all trees() together.
  std::size_t direction_nodes() const;

 private:
  struct Cell {
    DirectionTree sampling, building;
    double vertices = 0;
  };
  std::vector<Cell> cells_;
  LearningRounds rounds_;
};

}  // namespace lacuna
