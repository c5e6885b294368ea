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

/// A point that a lobe is aimed at, and its weight.
struct Target {
  V3f at{0, 0, 0};    ///< scene units
  double weight = 0;  ///< > 0, of any scale
};

/// A mixture of power-cosine lobes around the directions to some points (Noel 2015, eq. 163, 167):
///     p(w) = sum_i c_i (s + 1) / (2 pi) max(0, w_i . w)^s
/// with w_i the direction from `x` to point i, c_i its weight over the sum of weights, s the
/// strength.
class LobeSet {
 public:
  LobeSet() = default;
  explicit LobeSet(std::span<const Target> targets);

  /// Nothing can be sampled.
  bool empty() const { return choice_.empty(); }
  std::size_t size() const { return choice_.size(); }

  /// Samples a unit direction at `x` with strength `s` >= 0; nothing if the sampled point is `x`
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
  /// The densities for the strengths power(k): each is computed from the square of the one before.
  std::array<float, doublings> pdf_of_powers(const V3f& x, const V3f& w) const;

 private:
  static constexpr float norm = 0.159154943F;  // 1 / (2 pi)
  /// Eight lobes side by side; those beyond the last have share 0.
  struct alignas(32) Block {
    std::array<float, 8> x, y, z, share;
  };

  /// How often a number is squared for its power `s`, if it is one of power(k): cheaper than
  /// others.
  static std::optional<int> squares_of(float s) {
    const auto bits = std::bit_cast<std::uint32_t>(s);
    const int exponent = static_cast<int>(bits >> 23) - 127;
    const bool is_power = (bits & 0x7fffff) == 0 && exponent >= 0 && exponent < int{doublings};
    return is_power ? std::optional(exponent) : std::nullopt;
  }
  /// Calls `use(cosine, share)` for all blocks: max(0, w_i . w), and c_i.
  template <class Use>
  void for_each_cosine(const V3f& x, const V3f& w, const Use& use) const {
    for (const Block& b : blocks_) {
      const Float8x3 d{Float8::load(b.x.data()) - x.x, Float8::load(b.y.data()) - x.y,
                       Float8::load(b.z.data()) - x.z};
      const Float8 along = dot(d, Float8x3{w.x, w.y, w.z});
      // Of a point at x itself no direction is known: 0 / 0 becomes 0 in max(), whose second
      // operand wins.
      use(min(max(along / sqrt(length2(d)), 0.0F), 1.0F), Float8::load(b.share.data()));
    }
  }

  std::vector<V3f> points_;
  std::vector<Block> blocks_;
  AliasTable choice_;
};

}  // namespace lacuna
