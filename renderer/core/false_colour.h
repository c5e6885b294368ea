#pragma once

#include <cmath>
#include <cstdint>

#include "renderer/core/vec.h"

namespace lacuna {

/// A colour for a label: a hash of label and seed, so that neighbouring labels differ clearly.
/// Components in [0.1, 1].
inline Rgb false_colour(std::uint32_t label, std::uint64_t seed) {
  // The finaliser of SplitMix64 (Steele, Lea and Flood 2014).
  std::uint64_t h = label + seed * 0x9e3779b97f4a7c15u + 0x9e3779b97f4a7c15u;
  h = (h ^ h >> 30) * 0xbf58476d1ce4e5b9u;
  h = (h ^ h >> 27) * 0x94d049bb133111ebu;
  h ^= h >> 31;
  const auto unit = [&h](int shift) { return static_cast<float>(h >> shift & 0xffff) / 65536.0F; };
  const float hue = 6 * unit(0), value = 0.6F + 0.4F * unit(16), least = 0.1F + 0.3F * unit(32);
  const auto channel = [&](float at) {
    const float distance = std::abs(std::remainder(hue - at, 6.0F));
    const float full = std::min(1.0F, std::max(0.0F, 2 - distance));
    return least + (value - least) * full;
  };
  return {channel(0), channel(2), channel(4)};
}

}  // namespace lacuna
