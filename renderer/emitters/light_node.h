#pragma once

#include <immintrin.h>

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "renderer/core/vec.h"
#include "renderer/emitters/emitter_bounds.h"

namespace lacuna {

/// Up to eight children of a node of a light tree, in two cache lines: the time of a descent among
/// a million emitters is the latency of its nodes. Centres have 8 bits in a cube around all
/// centres, radii and intensities 16, directions 8. Rounding only enlarges spheres and cones, so no
/// emission towards a point is missed. Every reader decodes the same numbers.
struct alignas(128) LightNode {
  static constexpr int width = 8;
  using Bytes = std::array<std::uint8_t, width>;
  using SignedBytes = std::array<std::int8_t, width>;
  using Halves = std::array<std::uint16_t, width>;

  LightNode() = default;
  /// A node of 1 to 8 children; `first`, `nodes` and `bundles` stay 0.
  explicit LightNode(std::span<const EmitterBounds> children);

  V3f origin{0, 0, 0};          ///< the low corner of the cube around the children's centres
  float step = 0;               ///< side of that cube / 255
  std::uint32_t first = 0;      ///< the first child that is a node; the others follow it
  std::uint8_t nodes = 0;       ///< a bit for each child that is a node, not an entry
  std::uint8_t bundles = 0;     ///< a bit for each child node that is a bundle
  std::uint8_t both_sides = 0;  ///< a bit for each child that emits to both sides
  std::uint8_t count : 4 = 0;
  bool spots : 1 = false;         ///< some child emits within less than 90 degrees of an axis only
  std::array<Bytes, 3> centre{};  ///< of the child's box, in steps from the origin
  Halves r{};                     ///< at least half the diagonal of its box: see radii()
  std::array<SignedBytes, 3> back{};                    ///< opposite of the axis, times 127
  SignedBytes cos_spread{}, sin_spread{}, cos_reach{};  ///< times 127
  Halves
      intensity{};  ///< relative to the node's largest, in (0, 1]: see intensities(); 0: no child

  /// Whether child `i` is a node.
  bool is_node(int i) const { return (nodes >> i & 1) != 0; }
  /// The index of the node that is child `i`.
  std::uint32_t node(int i) const {
    return first + static_cast<std::uint32_t>(std::popcount(nodes & ((1U << i) - 1)));
  }

  /// Coordinate `k` of the children's centres, relative to `from`.
  __m256 centres(int k, float from) const {
    const __m128i bytes = load64(centre[static_cast<std::size_t>(k)].data());
    return _mm256_fmadd_ps(_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(bytes)), _mm256_set1_ps(step),
                           _mm256_set1_ps(origin[k] - from));
  }
  /// Decoded from the upper 16 of 31 bits of a non-negative float.
  __m256 radii() const { return _mm256_castsi256_ps(_mm256_slli_epi32(words(r), radius_shift)); }
  /// Decoded from the upper 16 of 30 bits of a float in [0, 2).
  __m256 intensities() const {
    return _mm256_castsi256_ps(_mm256_slli_epi32(words(intensity), intensity_shift));
  }
  /// Numbers in [-1, 1], times 127, as floats.
  static __m256 signed_bytes(const SignedBytes& v) {
    return _mm256_cvtepi32_ps(_mm256_cvtepi8_epi32(load64(v.data())));
  }

  static constexpr int radius_shift = 15, intensity_shift = 14;

 private:
  static __m128i load64(const void* p) { return _mm_loadl_epi64(static_cast<const __m128i*>(p)); }
  static __m256i words(const Halves& v) {
    return _mm256_cvtepu16_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(v.data())));
  }
};
static_assert(sizeof(LightNode) == 128);

}  // namespace lacuna
