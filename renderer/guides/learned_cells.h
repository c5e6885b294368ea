#pragma once

#include "renderer/guides/aimed_lobes.h"
#include "renderer/guides/direction_tree.h"
#include "renderer/path/learning_rounds.h"
#include "renderer/path/training_samples.h"

namespace lacuna {

/// A guide divides into at most so many cells.
inline constexpr std::size_t most_learned_cells = std::size_t{1} << 18;

/// The light that paths found at the vertices of each cell of a guide: `Directions` are AimedLobes,
/// or DirectionTrees (Mueller, Gross and Novak 2017). It is learned in LearningRounds: a round
/// samples the directions of the round before, and builds those of the next one.
template <class Directions>
class LearnedCells {
 public:
  LearnedCells() = default;
  /// One cell for each of `first`, from which directions are sampled before anything is learned.
  explicit LearnedCells(std::vector<Directions> first);
  explicit LearnedCells(std::size_t cells) : LearnedCells(std::vector<Directions>(cells)) {}

  std::size_t size() const { return cells_.size(); }
  /// What is sampled in this round; empty where nothing is known.
  const Directions& directions(std::size_t cell) const { return cells_[cell].sampling; }
  /// Vertices of paths in this round.
  double vertices(std::size_t cell) const { return cells_[cell].vertices; }
  /// Vertices above which a cell is divided at the end of this round, where `first` are of a round
  /// of one iteration: the paper's c sqrt(2^k) grows with the number of samples.
  double most_vertices(int first) const;
  /// Rounds that have ended.
  std::uint64_t rounds() const { return rounds_.ended(); }

  /// Adds the samples of a pass. True: a round ends. Cells may then be divided, and
  /// next_round() must be called.
  bool update(const TrainingSamples& samples, const ThreadPool& pool);
  /// Adds a cell that starts as a copy of `cell`; each has half of its vertices.
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
