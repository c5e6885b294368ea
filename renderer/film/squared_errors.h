#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace lacuna {

/// The squared errors of single iterations, of which `est_rmse` and the layer `variance` are means.
/// Where their distribution has a heavy tail the mean of those seen says little: the rare ones that
/// carry it are still to come. The largest are kept, so that the tail can be fitted
/// (renderer/film/pareto_tail.h).
///
/// A picture counts as 16 interleaved ones of a sixteenth of its pixels: they see the same scene,
/// and give enough values after few iterations.
class SquaredErrors {
 public:
  static constexpr std::size_t kept = 4096;
  /// Pixels with equal column mod `side` and equal row mod `side` are one of the pictures.
  static constexpr int side = 4;
  using Sums = std::array<double, std::size_t(side) * side>;

  /// Adds one iteration: the sums over the interleaved pictures of a picture of `width` x `height`.
  void add(const Sums& sums, int width, int height);

  /// Adds the values of another.
  void merge(const SquaredErrors& other);

  /// How many values were added.
  std::uint64_t count() const { return count_; }
  /// The `kept` largest values, ascending.
  std::vector<double> largest() const;

  /// For checkpoints. load() throws std::runtime_error on what save() never writes.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  void add(double value);

  std::uint64_t count_ = 0;
  std::vector<double> heap_;  ///< the smallest in front
};

}  // namespace lacuna
