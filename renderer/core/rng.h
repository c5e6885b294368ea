#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "renderer/core/sobol.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// A source of random words for streams that are stored and mutated (primary samples:
/// renderer/path/primary_samples.h).
class RandomWords {
 public:
  using Block = std::array<std::uint32_t, 16>;
  virtual ~RandomWords() = default;
  /// Writes the next words of the stream.
  virtual void next(Block& out) = 0;
};

/// A counter-based random number generator: Philox4x32-10 (Salmon et al. 2011, "Parallel random
/// numbers: as easy as 1, 2, 3"). The stream is a pure function of (seed, iteration, path,
/// purpose), so an image does not depend on threads, on their order, or on a kill and a resume.
///
/// A stream may instead be a sample of a low-discrepancy sequence, its numbers the dimensions. Each
/// number, and each pair of next2(), is uniform; samples of one sequence are not independent.
class Rng {
 public:
  /// The use of a stream; the streams of different purposes are independent.
  enum class Purpose : std::uint32_t {
    eye_path = 0,
    light_path = 1,
    emission_ranges = 2,
    test = 3,
    visibility = 4,
    gather = 5,
    particles = 6,
    branch = 7,
    bootstrap = 8,
    chain = 9,
    groups = 10,
    emission_means = 11,
    eye_records = 12,
    arriving_power = 13,
    cache_points = 14,
    passes = 15,
    face_paths = 16,
    one_ray = 17
  };

  /// `path` < 2^56; `iteration` < 2^32.
  Rng(std::uint64_t seed, std::uint64_t iteration, std::uint64_t path,
      Purpose purpose = Purpose::eye_path)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        counter_{0, static_cast<std::uint32_t>(path),
                 static_cast<std::uint32_t>(path >> 32) | static_cast<std::uint32_t>(purpose) << 24,
                 static_cast<std::uint32_t>(iteration)} {}

  /// The stream of `words`, which must outlive it.
  explicit Rng(RandomWords& words) : Rng(0, 0, 0) {
    words_ = &words;
    source_ = Source::kept;
    vertex_ = static_cast<std::uint8_t>(numbers_.size() - 1);
  }

  /// Sample `index` of the low-discrepancy sequence of `seed`, `sequence`, `randomisation` and
  /// `purpose`; sequences that differ in any of these are independent. `sequence` < 2^56,
  /// `randomisation` < 2^31. Only aligned runs of 2^m indices, m <= 32, are well distributed.
  static Rng of_sequence(std::uint64_t seed, std::uint64_t sequence, std::uint32_t randomisation,
                         std::uint64_t index, Purpose purpose) {
    Rng rng(seed, 0, sequence, purpose);
    // No independent stream has this counter: their first word starts at 0.
    const Block key = philox({1U << 31 | randomisation, rng.counter_[1], rng.counter_[2],
                              static_cast<std::uint32_t>(index >> 32)},
                             rng.key_);
    rng.sobol_ = SobolSample({key[0], key[1]}, static_cast<std::uint32_t>(index));
    rng.source_ = Source::sobol;
    rng.pair_ = 1;
    rng.vertex_ = 7;
    return rng;
  }

  /// Call it at each vertex of a path. With stored words each vertex begins a block, so a mutation
  /// of one vertex keeps the numbers of the others. In a low-discrepancy sequence each vertex
  /// begins at a multiple of 8 dimensions, so a dimension has the same use in paths that took
  /// different numbers of them before. No effect in other streams.
  void next_vertex() { used_ = (used_ + vertex_) & ~std::size_t{vertex_}; }

  /// An independent stream, keyed by the next 64 bits of this one.
  Rng branch() {
    const std::uint64_t low = next_u32();
    return Rng(low | std::uint64_t{next_u32()} << 32, 0, 0, Purpose::branch);
  }

  /// 32 uniform bits.
  std::uint32_t next_u32() {
    if (used_ == numbers_.size()) refill();
    return numbers_[used_++];
  }

  /// Uniform in [0, 1), a multiple of 2^-24: never 1.
  float next() { return unit(next_u32()); }

  /// Two independent uniforms in [0, 1); in a low-discrepancy sequence, a pair of dimensions.
  V2f next2() {
    used_ += used_ & pair_;
    const float a = next();
    return {a, next()};
  }

  /// Uniform in [0, 1), a multiple of 2^-53, to select by weights of any ratio. Takes two numbers.
  double next_choice() {
    const std::uint64_t high = next_u32();
    return static_cast<double>((high << 32 | next_u32()) >> 11) * 0x1p-53;
  }

  /// A uniform to select by, and a point in the unit square: all independent, from three numbers.
  struct ChoiceAndPoint {
    double choice;  ///< in [0, 1), a multiple of 2^-48
    V2f point;      ///< as next2()
  };
  ChoiceAndPoint next_choice_and_point() {
    used_ += used_ & pair_;
    const std::uint32_t b = next_u32();
    const std::uint32_t c = next_u32();
    const std::uint64_t a = next_u32();
    // The low bits, which the point does not use.
    const std::uint64_t choice = a << 16 | (b & 0xff) << 8 | (c & 0xff);
    return {static_cast<double>(choice) * 0x1p-48, {unit(b), unit(c)}};
  }

  /// A point in the unit square and an independent uniform number, from four numbers. The high bits
  /// of x can select an entry of a table, and its remaining bits place a point there.
  struct FinePoint {
    std::uint64_t x;         ///< of 2^64
    std::uint32_t y;         ///< of 2^32
    std::uint32_t u_select;  ///< of 2^32; decides a selection, as between a bin and its alias

    V2f point() const { return {unit(static_cast<std::uint32_t>(x >> 32)), unit(y)}; }
  };
  FinePoint next_fine_point() {
    used_ += used_ & pair_;
    const std::uint64_t high = next_u32();
    const std::uint32_t y = next_u32();
    const std::uint32_t low = next_u32();
    return {high << 32 | low, y, next_u32()};
  }

  /// Uniform in 0 ... n - 1, n <= 2^32, each probability to within n 2^-32 of itself.
  std::uint64_t below(std::uint64_t n) { return (n * next_u32()) >> 32; }

  /// True with probability `p`, to 2^-64; next() < p would round small ones up to 2^-24.
  bool decide(float p) {
    const double scaled = double(p) * 0x1p32;
    const double whole = std::floor(scaled);
    const double u = next_u32();
    if (u != whole) return u < whole;
    return next_u32() < (scaled - whole) * 0x1p32;
  }

  using Block = std::array<std::uint32_t, 4>;
  /// The bijection of Philox; next_u32() returns the words of its values at successive counters.
  static Block philox(Block c, std::array<std::uint32_t, 2> k) {
    for (int round = 0; round < 10; ++round) {
      const std::uint64_t p0 = multiplier_0 * c[0];
      const std::uint64_t p1 = multiplier_1 * c[2];
      c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(p1),
           static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(p0)};
      k[0] += weyl_0;
      k[1] += weyl_1;
    }
    return c;
  }

 private:
  static float unit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }

  static constexpr std::uint64_t multiplier_0 = 0xD2511F53, multiplier_1 = 0xCD9E8D57;
  static constexpr std::uint32_t weyl_0 = 0x9E3779B9, weyl_1 = 0xBB67AE85;

  void refill();
  /// Computes four blocks at once, one in each 64-bit lane (values in the low halves).
  void refill_by_philox();

  enum class Source : std::uint8_t { philox, sobol, kept };

  alignas(32) RandomWords::Block numbers_;
  std::size_t used_ = 16;
  Source source_ = Source::philox;
  std::uint8_t pair_ = 0;    // 1: next2() begins at an even number
  std::uint8_t vertex_ = 0;  // a vertex begins at a multiple of vertex_ + 1
  SobolSample sobol_;
  RandomWords* words_ = nullptr;
  std::array<std::uint32_t, 2> key_;
  Block counter_;
};

}  // namespace lacuna
