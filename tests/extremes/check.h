#pragma once

#include <functional>
#include <string>

#include "tests/extremes/picture.h"
#include "tests/statistics.h"

namespace lacuna::extremes {

/// What a cell of the matrix came to.
struct Verdict {
  enum class Kind { ok, refused, red, left_out };
  Kind kind = Kind::ok;
  std::string why = {};       ///< of all but `ok`
  double p = 1;               ///< smallest p-value of the cell's statistical tests
  std::string doubtful = {};  ///< which test that was, and what it found
  std::size_t tests = 0;      ///< how many there were
};

/// Gathers what is found wrong in one cell. The p-values wait until the number of all tests is
/// known.
class Check {
 public:
  void require(bool holds, const std::string& otherwise);
  /// `action` must throw, and what it says must contain `word`; then the cell was refused.
  void refused(const std::function<void()>& action, const std::string& word);

  /// `action` may throw what a job is refused with (BadJob, SceneError, GeometryError,
  /// MemoryLimitError); then the cell was refused, for that reason.
  void or_refused(const std::function<void()>& action);

  /// All finite, nothing rejected.
  void sound(const Picture& a);
  /// Every pixel of `a` is `factor` times that of `b`, to the last bit.
  void same_bits(const Picture& a, const Picture& b, double factor);
  /// `a` and `b` have the same random numbers: the mean of their iterations' differences, a -
  /// factor b, is 0 in every block, but for a share `rounding` of what is there.
  void same_picture(const Picture& a, const Picture& b, double factor, double rounding);
  /// `a` and `b` are independent estimates of one picture.
  void agree(const Picture& a, const Picture& b);
  /// The mean of the picture is known.
  void mean_is(const Picture& a, double expected);
  /// The mean of every block has a bound.
  void at_most(const Picture& a, double bound);

  const Verdict& verdict() const { return verdict_; }

 private:
  void note_refusal(const std::string& why);
  void test(double p, const std::string& what);
  /// Fails where the noise would hide what the test is for.
  void has_power(double standard_error, double mean);

  Verdict verdict_;
};

/// Moments over iterations of the picture's mean.
statistics::Moments mean_of(const Picture& a);

/// The k of {0, 1, 2, -1, -2} for which every pixel of `twice` is 2^k times that of `once`, to the
/// last bit: a power of two moves nothing but exponents. Throws std::runtime_error: there is none.
int degree(const Picture& twice, const Picture& once);

}  // namespace lacuna::extremes
