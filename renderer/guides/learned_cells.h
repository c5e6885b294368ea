#pragma once

#include "renderer/guides/aimed_lobes.h"
#include "renderer/guides/direction_tree.h"
#include "renderer/path/learning_rounds.h"
#include "renderer/path/training_samples.h"

namespace lacuna {

/// Largest number of cells of a guide.
inline constexpr std::size_t most_learned_cells = std::size_t{1} << 18;

/// The light that paths gathered at the vertices of each cell of a guide. `Directions` are
/// AimedLobes, or DirectionTrees (Mueller, Gross and Novak 2017). Training proceeds in
/// LearningRounds: a round samples the directions of the previous round and builds those of the
/// next one.
template <class Directions>
class LearnedCells {
 public:
  LearnedCells() = default;
  /// One cell for each of `first`, whose directions are sampled before the first round ends.
  explicit LearnedCells(std::vector<Directions> first);
  explicit LearnedCells(std::size_t cells) : LearnedCells(std::vector<Directions>(cells)) {}

  std::size_t size() const { return cells_.size(); }
  /// The directions sampled in this round; empty if there are no data.
  const Directions& directions(std::size_t cell) const { return cells_[cell].sampling; }
  /// The number of path vertices in this round.
  double vertices(std::size_t cell) const { return cells_[cell].vertices; }
  /// The number of vertices above which a cell is split at the end of this round, if `first` is the
  /// number for a round of one iteration: the paper's c sqrt(2^k), proportional to the root of the
  /// number of samples.
  double most_vertices(int first) const;
  /// The number of rounds that have ended.
  std::uint64_t rounds() const { return rounds_.ended(); }

  /// Adds the samples of a pass. Returns whether a round ends: then cells may be split, and
  /// next_round() must be called.
  bool update(const TrainingSamples& samples, const ThreadPool& pool);
  /// Adds a copy of `cell`; both get half of its vertices.
  void divide(std::size_t cell);
  void next_round(const ThreadPool& pool);

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error if the data is not valid.
  void load(ByteReader& in);

 private:
  struct Cell {
    Directions sampling, building;
    double vertices = 0;
  };
  std::vector<Cell> cells_;
  LearningRounds rounds_;
};

}  // namespace lacuna
