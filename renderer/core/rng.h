#pragma once

#include <array>
#include <cstdint>

#include "renderer/core/vec.h"

namespace lacuna {

/// Counted random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers: as easy as
/// 1, 2, 3"). The stream is a pure function of (seed, iteration, path, purpose), so an image does
/// not depend on threads, on their order, or on a kill and a resume.
class Rng {
 public:
  /// What the path is for; two purposes never share numbers.
  enum class Purpose : std::uint32_t { eye_path = 0, light_path = 1, integrator = 2, test = 3 };

  /// `path` < 2^56; `iteration` < 2^32.
  Rng(std::uint64_t seed, std::uint64_t iteration, std::uint64_t path,
      Purpose purpose = Purpose::eye_path)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        counter_{0, static_cast<std::uint32_t>(path),
                 static_cast<std::uint32_t>(path >> 32) | static_cast<std::uint32_t>(purpose) << 24,
                 static_cast<std::uint32_t>(iteration)} {}

  /// 32 uniform bits.
  std::uint32_t next_u32() {
    if (used_ == 4) {
      block_ = philox(counter_, key_);
      ++counter_[0];
      used_ = 0;
    }
    return block_[used_++];
  }

  /// Uniform in [0, 1), a multiple of 2^-24: never 1.
  float next() { return static_cast<float>(next_u32() >> 8) * 0x1p-24F; }

  /// Two independent uniforms in [0, 1).
  V2f next2() {
    const float a = next();
    return {a, next()};
  }

  using Block = std::array<std::uint32_t, 4>;
  /// The bijection itself, for its known-answer test.
  static Block philox(Block c, std::array<std::uint32_t, 2> k) {
    for (int round = 0; round < 10; ++round) {
      const std::uint64_t p0 = 0xD2511F53ULL * c[0];
      const std::uint64_t p1 = 0xCD9E8D57ULL * c[2];
      c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(p1),
           static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(p0)};
      k[0] += 0x9E3779B9U;
      k[1] += 0xBB67AE85U;
    }
    return c;
  }

 private:
  std::array<std::uint32_t, 2> key_;
  Block counter_;
  Block block_{};
  int used_ = 4;
};

}  // namespace lacuna
