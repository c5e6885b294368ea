#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace lacuna {

/// The squared errors of single iterations; `est_rmse` and the layer `variance` are means of them.
/// If their distribution is heavy-tailed, the sample mean is unreliable: the rare values that
/// dominate it have not occurred yet. The largest values are kept, to fit the tail
/// (renderer/film/pareto_tail.h).
///
/// A picture counts as 16 interleaved pictures with a sixteenth of its pixels each: they show the
/// same scene, and yield enough values after few iterations.
class SquaredErrors {
 public:
  static constexpr std::size_t kept = 4096;
  /// Pixels with equal column mod `side` and equal row mod `side` form one of these pictures.
  static constexpr int side = 4;
  using Sums = std::array<double, std::size_t(side) * side>;

  /// Adds one iteration: the sums over each interleaved picture of a picture of `width` x `height`.
  void add(const Sums& sums, int width, int height);

  /// Adds the values of `other`.
  void merge(const SquaredErrors& other);

  /// The number of values added.
  std::uint64_t count() const { return count_; }
  /// The `kept` largest values, ascending.
  std::vector<double> largest() const;

  /// For checkpoints. load() throws std::runtime_error on states that save() never writes.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  void add(double value);

  std::uint64_t count_ = 0;
  std::vector<double> heap_;  ///< smallest value first
};

}  // namespace lacuna
