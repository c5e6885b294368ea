#pragma once

#include <cmath>

#include "renderer/guides/aimed_lobes.h"
#include "renderer/guides/direction_tree.h"
#include "renderer/guides/guiding_distribution.h"
#include "renderer/guides/learning_rounds.h"

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
  explicit LearnedCells(std::size_t cells) : cells_(cells) {}

  std::size_t size() const { return cells_.size(); }
  /// What the last round found; empty where it found nothing.
  const Directions& directions(std::size_t cell) const { return cells_[cell].sampling; }
  /// Vertices of paths in this round.
  double vertices(std::size_t cell) const { return cells_[cell].vertices; }
  /// Vertices above which a cell is divided at the end of this round, where `first` are of a round
  /// of one iteration: the paper's c sqrt(2^k) grows with the number of samples.
  double most_vertices(int first) const { return double(first) * std::sqrt(rounds_.length()); }
  /// Rounds that have ended.
  std::uint64_t rounds() const { return rounds_.ended(); }

  struct Found {
    std::uint32_t cell;
    FoundLight light;
  };
  /// The samples of one part of an iteration.
  struct Accumulator {
    std::vector<std::uint32_t> vertices;  // the cell of each
    std::vector<Found> samples;

    /// What it takes until update() and in it, bytes.
    double bytes() const {
      return double(vertices.capacity() * sizeof(vertices[0]) +
                    samples.capacity() * sizeof(samples[0]) + samples.size() * sizeof(FoundLight));
    }
  };
  /// A vertex of `cell` < size() from which `light` was found in the direction of `sample`.
  static void accumulate(std::uint32_t cell, const GuidingSample& sample, float light,
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

 private:
  struct Cell {
    Directions sampling, building;
    double vertices = 0;
  };
  std::vector<Cell> cells_;
  LearningRounds rounds_;
};

}  // namespace lacuna
