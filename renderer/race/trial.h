#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/film/image.h"
#include "renderer/film/squared_errors.h"
#include "renderer/race/block_grid.h"

namespace lacuna {

/// What iterations of one method, independent estimates of one picture, say of its noise and cost.
/// Errors are squared errors, the mean of the three channels. While time is short, the estimates
/// are of smaller pictures: errors and costs are always those of the whole picture's pixels, as if
/// each of them had the error of the larger pixel that it lies in.
class Trial {
 public:
  Trial() = default;
  /// `width` x `height`: of the whole picture. `reduction`: BlockGrid's.
  Trial(int width, int height, int reduction = 1);

  /// Forgets the estimates of smaller pictures: from here on they are whole. Iterations and costs
  /// go on. charge() is to be called next.
  void restart_whole();

  /// Adds the estimate of one iteration, of grid().trial_width() x trial_height() pixels.
  void add(const Image& estimate);
  /// Counts the cost of an iteration, whether its estimate is added or not: CPU seconds of each
  /// thread, or rays. `share`: the part of the picture that it rendered.
  void charge(double cost, double share = 1);

  std::uint64_t estimates() const { return estimates_; }  ///< that were added
  std::uint64_t iterations() const { return charged_; }
  double cost() const { return cost_; }  ///< of all iterations
  /// Of an iteration of the whole picture.
  double iteration_cost() const {
    return pictures_charged_ > 0 ? (cost_ - cost_of_smaller_) / pictures_charged_ : 0;
  }
  /// Of one more iteration, of a smaller picture where those are.
  double next_cost() const { return iteration_cost() * grid_.trial_share(); }
  const BlockGrid& grid() const { return grid_; }
  /// Of the estimates that were added.
  const Image& mean() const { return mean_; }

  /// The variance of one iteration, summed over the pixels of each block; unbiased. All 0 with
  /// fewer than two estimates.
  std::vector<double> variances() const;
  /// The same from every other deviation, so that two halves judge each other. `half`: 0 or 1. All
  /// 0 with fewer than two and three estimates.
  std::vector<double> variances(int half) const;
  /// Whether both halves have variances.
  bool has_halves() const { return estimates_ >= 3; }

  /// By what factor variances() will have grown after `iterations` more, because the rare paths
  /// that carry much of a heavy tail are still to come (ParetoTail::mean_above()). At least 1; 1
  /// with too few estimates to say.
  double growth(double iterations) const;
  /// Whether the tail lets the variance be known (ParetoTail::mean_is_known()). None with too few
  /// estimates to say.
  std::optional<bool> tail_is_known() const;

  /// For checkpoints. load() into a trial of the same size; throws std::runtime_error on what
  /// save() never writes.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  BlockGrid grid_;
  Image mean_;
  std::uint64_t estimates_ = 0, charged_ = 0;
  double cost_ = 0;
  double cost_of_smaller_ = 0;   ///< before restart_whole()
  double pictures_charged_ = 0;  ///< the sum of their shares, since then
  /// Sums over the pixels of a block, of deviations 0, 2, 4... and 1, 3, 5...
  std::array<std::vector<double>, 2> sums_;
  /// Of whole pictures: pixels differ in their noise, which is no tail.
  SquaredErrors pictures_;
};

}  // namespace lacuna
