// Means of textures over triangles: near those of many lookups, never 0 where a lookup is not, and
// at the cost of a few hundred reads whatever the triangle.

#include "renderer/images/texture_means.h"

#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::encode8;

using Corners = std::array<V2f, 3>;

Texture decoded_texture(const test::Bytes& image, Texture::Wrap wrap = Texture::Wrap::repeat,
                        Texture::Encoding encoding = Texture::Encoding::linear) {
  Texture texture("test", image, encoding, wrap, wrap);
  texture.decode();
  return texture;
}

/// A grey texture of `width` x `height` texels, `value(x, y)` each.
template <class Value>
Texture grey(int width, int height, Texture::Wrap wrap, Value&& value) {
  std::vector<std::uint8_t> texels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) texels.push_back(static_cast<std::uint8_t>(value(x, y)));
  }
  return decoded_texture(encode8(width, height, 1, texels), wrap);
}

float largest(const Corners& uv) {
  float most = 0;
  for (const V2f& c : uv) most = std::max({most, std::abs(c.x), std::abs(c.y)});
  return most;
}

V2f at(const Corners& uv, double u, double v) {
  const auto a = static_cast<float>(u), b = static_cast<float>(v);
  return uv[0] * (1 - a - b) + uv[1] * a + uv[2] * b;
}

/// The mean of lookup() over n^2 points of a triangle, and the largest value found.
struct Sampled {
  double mean = 0, most = 0;
};
Sampled sampled(const Texture& texture, const Corners& uv, int n) {
  Sampled s;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      double u = (i + 0.5) / n, v = (j + 0.5) / n;
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const auto value = double(texture.lookup(at(uv, u, v)).rgb.x);
      s.mean += value / (n * n);
      s.most = std::max(s.most, value);
    }
  }
  return s;
}

/// Triangles from far below a texel to many repeats, some of them slivers or without area, in and
/// beside [0, 1].
Corners some_triangle(Rng& rng) {
  const auto spread = [&](double low, double high) {
    return low * std::pow(high / low, double(rng.next()));
  };
  const auto signed_one = [&] { return 2 * double(rng.next()) - 1; };
  const double size = spread(1e-5, 30), thin = rng.next() < 0.3F ? spread(1e-6, 1) : 1.0;
  const double turn = 6.28 * double(rng.next()), away = rng.next() < 0.5F ? 1 : spread(1, 1000);
  const Imath::V2d o(away * signed_one(), away * signed_one());
  Corners uv;
  for (V2f& c : uv) {
    const double x = size * signed_one(), y = thin * size * signed_one();
    c = V2f(Imath::V2d(o.x + x * std::cos(turn) - y * std::sin(turn),
                       o.y + x * std::sin(turn) + y * std::cos(turn)));
  }
  if (rng.next() < 0.05F) uv[1] = uv[0];
  if (rng.next() < 0.05F) uv[2] = uv[0];
  return uv;
}

constexpr std::array wraps{Texture::Wrap::repeat, Texture::Wrap::mirrored, Texture::Wrap::clamp};
constexpr std::array<std::array<int, 2>, 6> sizes{
    {{1, 1}, {3, 5}, {64, 64}, {37, 21}, {256, 1}, {190, 130}}};

TEST(TextureMeans, WholeIsLinear) {
  const Texture t = decoded_texture(encode8(2, 1, 4, {255, 0, 188, 255, 0, 0, 188, 51}),
                                    Texture::Wrap::repeat, Texture::Encoding::srgb);
  const V3d mean = TextureMeans(t).whole();
  EXPECT_NEAR(mean.x, 0.5, 1e-6);
  EXPECT_NEAR(mean.y, 0, 1e-6);
  EXPECT_NEAR(mean.z, 0.502886, 1e-5);
}

// What emits has a probability to be selected: where the mean is 0, so is every lookup. A triangle
// reads a few hundred cells at most.
TEST(TextureMeans, MissNothingThatIsLit) {
  int lit = 0, black = 0;
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (const Texture::Wrap wrap : wraps) {
    for (const auto& [width, height] : sizes) {
      const int period = width * height > 1000 ? 97 : 7;
      const Texture t = grey(width, height, wrap,
                             [&, w = width](int x, int y) { return (x + w * y) % period == 3; });
      const TextureMeans means(t);
      for (int i = 0; i < 300; ++i) {
        const Corners uv = some_triangle(rng);
        const TextureMeans::Mean mean = means.over(uv, largest(uv));
        EXPECT_LE(mean.cells, TextureMeans::most_cells);
        EXPECT_LE(mean.rgb.x, 1 / 255.0 + 1e-9);
        const bool found = sampled(t, uv, 16).most > 0;
        (found ? lit : black) += 1;
        EXPECT_TRUE(mean.rgb.x > 0 || !found) << "wrap " << int(wrap) << ", " << width << " x "
                                              << height << ": " << uv[0] << uv[1] << uv[2];
      }
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(black, 500);
}

// Triangles on the dark half of a texture have no power.
TEST(TextureMeans, AreBlackWhereAllIs) {
  const Texture t =
      grey(64, 64, Texture::Wrap::repeat, [](int x, int) { return x < 32 ? 0 : 255; });
  const TextureMeans means(t);
  const auto over = [&](const Corners& uv) { return means.over(uv, largest(uv)).rgb.x; };
  EXPECT_EQ(over({V2f(0.02F, 0), V2f(0.48F, 0), V2f(0.3F, 7)}), 0);
  EXPECT_EQ(over({V2f(5.1F, 0), V2f(5.2F, 0), V2f(5.1F, 0.1F)}), 0);
  EXPECT_EQ(over({V2f(0.3F, 0.3F), V2f(0.3F, 0.3F), V2f(0.3F, 0.3F)}), 0);
  EXPECT_NEAR(over({V2f(0.6F, 0), V2f(0.9F, 0), V2f(0.6F, 0.3F)}), 1, 1e-9);
  // Rows of four texels count as wide as they are anywhere: by 2 of 64 texels too wide.
  EXPECT_NEAR(over({V2f(0, 0), V2f(1, 0), V2f(1, 1)}), 0.75, 0.04);
  EXPECT_NEAR(over({V2f(0, 0), V2f(1, 0), V2f(0, 1)}), 0.25, 0.04);
  EXPECT_NEAR(over({V2f(-200, -300), V2f(400, 100), V2f(100, 500)}), 0.5, 0.01);
}

TEST(TextureMeans, AreNearThoseOfLookups) {
  Rng rng(2, 0, 0, Rng::Purpose::test);
  for (const Texture::Wrap wrap : wraps) {
    for (const auto& [width, height] : sizes) {
      // Bright in the middle, without a jump at the border.
      const Texture t = grey(width, height, wrap, [&, w = width, h = height](int x, int y) {
        const double a = std::sin(3.1416 * (x + 0.5) / w), b = std::sin(3.1416 * (y + 0.5) / h);
        return std::lround(255 * a * a * b * b);
      });
      const TextureMeans means(t);
      for (int i = 0; i < 30; ++i) {
        const Corners uv = some_triangle(rng);
        EXPECT_NEAR(means.over(uv, largest(uv)).rgb.x, sampled(t, uv, 128).mean, 0.2)
            << "wrap " << int(wrap) << ", " << width << " x " << height << ": " << uv[0] << uv[1]
            << uv[2];
      }
    }
  }
}

TEST(TextureMeans, AnyCoordinateIsSafe) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Texture::Wrap wrap : wraps) {
    const Texture t = grey(8, 8, wrap, [](int x, int y) { return x + y == 0 ? 255 : 0; });
    const TextureMeans means(t);
    for (const float bad : {inf, -inf, nan, 3e38F, -1e20F, 1e9F}) {
      const Corners uv{V2f(0.5F, 0.5F), V2f(bad, 0.5F), V2f(0.5F, bad)};
      const TextureMeans::Mean mean = means.over(uv, largest(uv));
      EXPECT_GT(mean.rgb.x, 0) << bad;
      EXPECT_LE(mean.rgb.x, 1) << bad;
    }
  }
}

}  // namespace
}  // namespace lacuna
