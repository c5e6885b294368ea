#include "renderer/images/texture.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "renderer/images/texture_decode.h"

namespace lacuna {
namespace {

/// The linear values of bytes: 256 entries for colours under an encoding, then 256 for alpha, which
/// is always linear. One table for both allows a texel's four bytes to be looked up at once.
using ByteTable = std::array<float, 512>;

/// IEC 61966-2-1.
double srgb_to_linear(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

ByteTable make_table(Texture::Encoding encoding) {
  ByteTable table{};
  for (std::size_t i = 0; i < 256; ++i) {
    const double c = static_cast<double>(i) / 255.0;
    table[i] = static_cast<float>(encoding == Texture::Encoding::srgb ? srgb_to_linear(c) : c);
    table[256 + i] = static_cast<float>(c);
  }
  return table;
}

const ByteTable linear_table = make_table(Texture::Encoding::linear);
const ByteTable srgb_table = make_table(Texture::Encoding::srgb);

/// The four linear values of the texel at `p`. Four loads were measured to be faster than a gather.
inline __m128 linear_texel(const std::uint8_t* p, const float* table) {
  return _mm_setr_ps(table[p[0]], table[p[1]], table[p[2]], table[256 + p[3]]);
}

inline __m128 lerp(__m128 a, __m128 b, __m128 t) {
  return _mm_add_ps(a, _mm_mul_ps(_mm_sub_ps(b, a), t));
}

/// The two texels around a coordinate, and its position between them.
struct Pair {
  int first, second;
  float weight;  ///< of `second`
};

/// Always inlined: a call would cost as much as the rest of a lookup.
[[gnu::always_inline]] inline Pair between(float u, int size, Texture::Wrap wrap) {
  // Reduced first: a huge coordinate would overflow the integers below.
  switch (wrap) {
    case Texture::Wrap::repeat:
      u -= std::floor(u);
      break;
    case Texture::Wrap::mirrored:
      u -= 2 * std::floor(u * 0.5F);
      u = u > 1 ? 2 - u : u;
      break;
    case Texture::Wrap::clamp:
      u = std::min(std::max(u, 0.0F), 1.0F);
      break;
  }
  const float x = u * static_cast<float>(size) - 0.5F;  // in [-0.5, size - 0.5]
  const float below = std::floor(x);
  Pair pair{static_cast<int>(below), static_cast<int>(below) + 1, x - below};
  // At the border, repeat continues on the other side; a mirrored border repeats its own texel.
  const bool around = wrap == Texture::Wrap::repeat;
  if (pair.first < 0) pair.first = around ? size - 1 : 0;
  if (pair.second >= size) pair.second = around ? 0 : size - 1;
  return pair;
}

}  // namespace

Texture::Texture(std::string label, std::vector<std::uint8_t> encoded, Encoding encoding,
                 Wrap wrap_s, Wrap wrap_t)
    : label_(std::move(label)),
      encoded_(std::move(encoded)),
      to_linear_(encoding == Encoding::srgb ? srgb_table.data() : linear_table.data()),
      wrap_s_(wrap_s),
      wrap_t_(wrap_t) {}

void Texture::decode() {
  if (decoded()) return;
  Rgba8Image image = decode_texture(encoded_, label_);
  width_ = image.width;
  height_ = image.height;
  texels_ = std::move(image.rgba);
  std::vector<std::uint8_t>().swap(encoded_);
}

std::uint64_t Texture::texels() const {
  return decoded() ? texels_.size() / 4 : texels_of_texture(encoded_, label_);
}

/// The four texels of a lookup, and their weights.
struct Texture::Footprint {
  const std::uint8_t* upper;  ///< rows
  const std::uint8_t* lower;
  std::size_t left, right;   ///< within a row
  float weight_x, weight_y;  ///< of right and lower
};

[[gnu::always_inline]] inline Texture::Footprint Texture::footprint(const V2f& uv) const {
  const bool usable = std::isfinite(uv.x) && std::isfinite(uv.y);
  const Pair x = usable ? between(uv.x, width_, wrap_s_) : Pair{0, 0, 0};
  const Pair y = usable ? between(uv.y, height_, wrap_t_) : Pair{0, 0, 0};
  const auto stride = static_cast<std::size_t>(width_) * 4;
  return {texels_.data() + static_cast<std::size_t>(y.first) * stride,
          texels_.data() + static_cast<std::size_t>(y.second) * stride,
          static_cast<std::size_t>(x.first) * 4,
          static_cast<std::size_t>(x.second) * 4,
          x.weight,
          y.weight};
}

void Texture::prefetch(const V2f& uv) const {
  // The right texels mostly share a cache line with the left ones.
  const Footprint f = footprint(uv);
  _mm_prefetch(reinterpret_cast<const char*>(f.upper + f.left), _MM_HINT_T0);
  _mm_prefetch(reinterpret_cast<const char*>(f.lower + f.left), _MM_HINT_T0);
}

Rgba Texture::lookup(const V2f& uv) const {
  const Footprint f = footprint(uv);
  const __m128 weight_x = _mm_set1_ps(f.weight_x);
  const __m128 top = lerp(linear_texel(f.upper + f.left, to_linear_),
                          linear_texel(f.upper + f.right, to_linear_), weight_x);
  const __m128 bottom = lerp(linear_texel(f.lower + f.left, to_linear_),
                             linear_texel(f.lower + f.right, to_linear_), weight_x);
  alignas(16) std::array<float, 4> out;
  _mm_store_ps(out.data(), lerp(top, bottom, _mm_set1_ps(f.weight_y)));
  return {Rgb(out[0], out[1], out[2]), out[3]};
}

}  // namespace lacuna
