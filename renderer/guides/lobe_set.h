#pragma once

#include <array>
#include <bit>
#include <optional>
#include <span>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/core/density.h"
#include "renderer/core/power8.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// A point at which a lobe is aimed, and its weight.
struct Target {
  V3f at{0, 0, 0};    ///< scene units
  double weight = 0;  ///< > 0, in any unit
};

/// A mixture of power-cosine lobes around the directions to points (Noel 2015, eq. 163, 167):
///     p(w) = sum_i c_i (s + 1) / (2 pi) max(0, w_i . w)^s
/// with w_i the direction from `x` to point i, c_i its normalised weight, and s the strength.
class LobeSet {
 public:
  LobeSet() = default;
  explicit LobeSet(std::span<const Target> targets);

  /// Whether nothing can be sampled.
  bool empty() const { return choice_.empty(); }
  std::size_t size() const { return choice_.size(); }

  /// Samples a unit direction at `x` with strength `s` >= 0; none if the selected point is `x`
  /// itself.
  std::optional<V3f> sample(const V3f& x, float s, Rng::FinePoint u) const;
  std::optional<V3f> sample(const V3f& x, float s, Rng& rng) const {
    return sample(x, s, rng.next_fine_point());
  }
  /// Density with which sample() returns unit `w`.
  Pdf<SolidAngle> pdf(const V3f& x, const V3f& w, float s) const {
    Float8 sum;
    if (const std::optional<int> squares = squares_of(s)) {
      for_each_cosine(x, w, [&](Float8 power, Float8 share) {
        for (int i = 0; i < *squares; ++i) power = power * power;
        sum = sum + share * power;
      });
    } else {
      for_each_cosine(x, w,
                      [&](Float8 cosine, Float8 share) { sum = sum + share * power8(cosine, s); });
    }
    return Pdf<SolidAngle>(reduce_add(sum) * (s + 1) * norm);
  }

  static constexpr std::size_t doublings = 10;
  /// 2^k, k < doublings.
  static constexpr float power(std::size_t k) { return static_cast<float>(1U << k); }
  /// The densities for the strengths power(k), by repeated squaring.
  std::array<float, doublings> pdf_of_powers(const V3f& x, const V3f& w) const;

 private:
  static constexpr float norm = 0.159154943F;  // 1 / (2 pi)
  /// Eight lobes in structure-of-arrays layout; unused ones have share 0.
  struct alignas(32) Block {
    std::array<float, 8> x, y, z, share;
  };

  /// The number of squarings that compute the power `s`, if it is one of power(k); none otherwise.
  /// Squaring is faster than a general power.
  static std::optional<int> squares_of(float s) {
    const auto bits = std::bit_cast<std::uint32_t>(s);
    const int exponent = static_cast<int>(bits >> 23) - 127;
    const bool is_power = (bits & 0x7fffff) == 0 && exponent >= 0 && exponent < int{doublings};
    return is_power ? std::optional(exponent) : std::nullopt;
  }
  /// Calls `use(cosine, share)` for all blocks, with max(0, w_i . w) and c_i.
  template <class Use>
  void for_each_cosine(const V3f& x, const V3f& w, const Use& use) const {
    for (const Block& b : blocks_) {
      const Float8x3 d{Float8::load(b.x.data()) - x.x, Float8::load(b.y.data()) - x.y,
                       Float8::load(b.z.data()) - x.z};
      const Float8 along = dot(d, Float8x3{w.x, w.y, w.z});
      // A point at x itself has no direction: max() turns 0 / 0 into 0, because it returns its
      // second operand for NaN.
      use(min(max(along / sqrt(length2(d)), 0.0F), 1.0F), Float8::load(b.share.data()));
    }
  }

  std::vector<V3f> points_;
  std::vector<Block> blocks_;
  AliasTable choice_;
};

}  // namespace lacuna
