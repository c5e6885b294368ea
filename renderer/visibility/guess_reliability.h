#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/many_lights/visibility_estimate.h"

namespace lacuna {

/// The answers of a guess for the lights of a block, as numbers below `codes(sources)`: a digit for
/// each source.
class GuessAnswers {
 public:
  enum Answer : std::uint8_t { occluded, partial, visible, unknown };
  static constexpr std::size_t answers = 4;
  static constexpr std::size_t codes(std::size_t sources) {
    return std::size_t{1} << (2 * sources);
  }
  /// The answer of source `s` of `sources`.
  static Answer answer(std::size_t code, std::size_t s, std::size_t sources) {
    return static_cast<Answer>(code >> (2 * (sources - 1 - s)) % 64 & (answers - 1));
  }

  /// Appends the answers of a source (GuessSource::Tile::guess()).
  void append(const VisibilityEstimate& d);
  void clear() { code_ = {}; }
  Int8 eight(int group) const { return truncate(code_.eight(group)); }
  std::uint32_t operator[](int i) const { return static_cast<std::uint32_t>(code_[i]); }

 private:
  Lanes code_;
};

/// How often shadow rays find a light visible, by the answers of a guess and by cell: the error
/// rates of the guess, both ways. The rate of a cell after n tests is
///
///     (n r + n_0 r_0) / (n + n_0),   r = sum v / x  /  sum 1 / x,   n_0 = 2,
///
/// with v the result of a test that was made with probability x, so that r is that of all lights
/// and not of those that are tested often, and r_0 the rate of the same answers in all cells, for
/// which r_0 = 1/2 (Laplace's rule of succession). Tests of an iteration count from the next one
/// on: rates do not depend on the tests that they decide. Sums are integers, so that they do not
/// depend on the order of the threads.
class GuessReliability {
 public:
  struct Tally {
    std::uint64_t tests = 0;
    std::uint64_t weights = 0;  ///< sum of 1 / x, in units of 1 / one
    std::uint64_t visible = 0;  ///< the same of the tests that found the light visible
    Tally& operator+=(const Tally& o) {
      tests += o.tests, weights += o.weights, visible += o.visible;
      return *this;
    }
    double rate() const { return double(visible) / double(weights); }
  };
  static constexpr std::uint64_t one = 1U << 8;

  /// Throws MemoryLimitError if there is no memory for the cells.
  void resize(std::size_t cells, std::size_t codes);
  /// The rates of a cell by code; null before the first update().
  const float* rates(std::size_t cell) const {
    return rates_.empty() ? nullptr : rates_.data() + cell * codes_;
  }
  /// The rate of a cell, in (0, 1), for all answers together; 1/2 before the first update().
  float rate(std::size_t cell) const {
    Tally all;
    for (std::size_t i = 0; i < codes_; ++i) all += sums_[cell * codes_ + i];
    const double n = double(all.tests), visible = all.tests > 0 ? n * all.rate() : 0;
    return static_cast<float>((visible + 1) / (n + 2));
  }
  std::size_t codes() const { return codes_; }

  /// Adds tallies of consecutive cells from `cell` on, to be used from the next update() on. Called
  /// by many threads.
  void add(std::size_t cell, std::span<const Tally> tallies);
  /// Drops what was added since update(): tests of an iteration that was stopped.
  void discard();
  void update();
  /// All tests of each code.
  std::vector<Tally> totals() const;

  void save(ByteWriter& out) const { out.put(sums_); }
  /// Throws std::runtime_error if the saved number of cells differs.
  void load(ByteReader& in);

 private:
  static constexpr double prior_tests = 2;
  void update_rates();

  std::size_t codes_ = 0;
  std::vector<Tally> sums_, added_;
  std::vector<float> rates_;
};

}  // namespace lacuna
