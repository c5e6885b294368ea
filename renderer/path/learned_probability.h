#pragma once

#include <span>
#include <vector>

#include "base/parallel/thread_pool.h"
#include "base/storage/bytes.h"
#include "renderer/path/training_samples.h"

namespace lacuna {

/// The probability of sampling a guiding distribution instead of the BSDF, learned for each cell:
/// stochastic gradient descent on the Kullback-Leibler divergence of the mixture
///
///     p = c p_guide + (1 - c) p_bsdf
///
/// from the light that vertices reflect (Mueller 2019, "Practical path guiding in production", ch.
/// 10 of the course "Path guiding in production"). With R the light that a sample reflected,
/// divided by the density of its direction (TrainingSample::reflected), its gradient with respect
/// to c is -R (p_guide - p_bsdf) / p. Steps are those of Adam (Kingma and Ba 2015). Their size does
/// not depend on the scale of R, so a rare bright path moves a cell no further than others. Of the
/// rules in those notes, this is the one without second moments, whose estimates have heavier
/// tails.
class LearnedProbability {
 public:
  LearnedProbability() = default;
  explicit LearnedProbability(std::size_t cells) : cells_(cells) {}

  std::size_t size() const { return cells_.size(); }
  /// The probability of a cell, within [8e-4, most_guided].
  float operator[](std::size_t cell) const { return static_cast<float>(cells_[cell].probability); }
  double mean() const;

  void update(const TrainingSamples& samples, const ThreadPool& pool);
  /// Adds a cell for each of `origins`: a copy of the cell of that index.
  void divide(std::span<const std::uint32_t> origins);

  void save(ByteWriter& out) const { out.put(cells_); }
  /// Throws std::runtime_error if the saved state is not valid for `cells` cells.
  void load(ByteReader& in, std::size_t cells);

 private:
  struct Cell {
    double parameter = 0;                     ///< t, probability: most_guided / (1 + e^-t)
    double mean = 0, square = 0;              ///< moving averages of the gradient and its square
    double first_mean = 1, first_square = 1;  ///< weights of their initial value 0, in (0, 1]
    double probability = first();

    void step(double gradient);
  };
  static double first();
  static void learn(Cell& cell, std::span<const TrainingSample> samples);

  std::vector<Cell> cells_;
};

}  // namespace lacuna
