#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace lacuna {

/// A sum as two doubles that do not overlap: `high` is the rounded sum, `low` the rounding error.
struct PairSum {
  double high = 0, low = 0;
};

/// Adds `x` to `sum` and returns the remainder that fits neither double; 0: the new sum is exact
/// (Knuth 1969, theorem 4.2.2B, three times).
inline double add_to(PairSum& sum, double x) {
  const double s = sum.high + x, s_part = s - sum.high;
  const double rest = (sum.high - (s - s_part)) + (x - s_part);
  const double t = sum.low + rest, t_part = t - sum.low;
  const double lost = (sum.low - (t - t_part)) + (rest - t_part);
  sum.high = s + t;
  const double part = sum.high - s;
  sum.low = (s - (sum.high - part)) + (t - part);
  return lost;
}

/// Adds another sum. Returns 0 if the new sum is exact.
inline double add_to(PairSum& sum, const PairSum& other) {
  const double of_high = std::abs(add_to(sum, other.high));
  return of_high + std::abs(add_to(sum, other.low));
}

/// A PairSum for each value of a picture. While no remainder is lost, the sums are exact and do not
/// depend on the order of additions. A sum of n floats is exact if n times the largest is below
/// 2^105 times the last bit of the smallest: for 2^24 iterations, if the values span a ratio below
/// 2^57.
class ExactSums {
 public:
  ExactSums() = default;
  explicit ExactSums(std::size_t size) : high_(size, 0.0), low_(size, 0.0) {}

  std::size_t size() const { return high_.size(); }
  PairSum operator[](std::size_t i) const { return {high_[i], low_[i]}; }
  /// The high and low parts, for loops over many sums.
  double* high() { return high_.data(); }
  double* low() { return low_.data(); }

  /// Adds the sums of `other`, of the same size. Returns false if a sum is no longer exact.
  bool add(const ExactSums& other);

  /// For checkpoints. load() keeps the size; it throws std::runtime_error on another size and on
  /// states that save() never writes. `what` names the sums in the error.
  void save(class ByteWriter& out) const;
  void load(class ByteReader& in, const std::string& what);

 private:
  std::vector<double> high_, low_;
};

}  // namespace lacuna
