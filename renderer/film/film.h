#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/parallel/thread_pool.h"
#include "renderer/film/exact_sums.h"
#include "renderer/film/image.h"
#include "renderer/film/squared_errors.h"

namespace lacuna {

/// For the means a and b of two independent parts of `na` and `nb` samples, E (a - b)^2 = s^2 (1/na
/// + 1/nb); the variance of the mean of all samples is s^2 / (na + nb). Returns the ratio of the
/// second to the first.
inline double scale_from_halves(double na, double nb) { return na * nb / ((na + nb) * (na + nb)); }

/// Accumulates iterations, each an estimate of the picture: the sum and the sum of squares of each
/// channel, in pairs of doubles, so that merging the films of disjoint iterations is bit-identical
/// to one film of all. Even and odd iterations have separate sums: the two halves estimate the
/// error without a reference.
class Film {
 public:
  Film() = default;
  Film(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  std::uint64_t iterations() const { return halves_[0].n + halves_[1].n; }

  /// Adds the estimate of iteration `iteration`; its parity selects the half. The bits are the same
  /// with and without a pool.
  void add(std::uint64_t iteration, const Image& estimate, const ThreadPool* pool = nullptr);
  /// Adds the iterations of `other`, which must be disjoint from this film's. Throws
  /// std::invalid_argument on another size.
  void merge(const Film& other);

  /// Mean over all iterations, interleaved RGB, in double. Zero before the first iteration.
  std::vector<double> mean() const;
  /// Mean of one half (0: even iterations, 1: odd).
  std::vector<double> half_mean(int half) const;
  std::uint64_t half_iterations(int half) const { return halves_[std::size_t(half)].n; }
  /// Variance of mean(): the unbiased variance of one iteration over the number of iterations. Zero
  /// with fewer than two iterations. Requires independent iterations.
  std::vector<double> variance_of_mean() const;
  /// Variance of mean() if only the two halves are independent, from their difference: unbiased,
  /// with one degree of freedom. Zero until both have an iteration.
  std::vector<double> variance_from_halves() const;
  /// Whether every sum is exact (see ExactSums), so that means do not depend on the order of
  /// iterations. Squares need twice the bits; if theirs are rounded, the error is beyond the
  /// hundredth bit.
  bool exact() const { return exact_; }
  /// Squared errors of all iterations except the first of each half (of each merged film), which
  /// has no earlier mean. The expectation of a value is the variance of one iteration, averaged
  /// over pixels and channels.
  const SquaredErrors& squared_errors() const { return squared_errors_; }

  /// Saves and restores the state, for checkpoints. load() throws std::runtime_error on another
  /// size and on states that save() never writes.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in);

 private:
  struct Half {
    std::uint64_t n = 0;
    ExactSums sums;
  };
  PairSum sum(std::size_t i) const;  ///< of both halves

  int width_ = 0, height_ = 0;
  std::array<Half, 2> halves_;
  ExactSums squares_;
  bool exact_ = true;
  SquaredErrors squared_errors_;
};

}  // namespace lacuna
