// The maps' texels and directions, one and eight at a time, and what covers a texel.

#include <gtest/gtest.h>

#include "renderer/view_maps/view_maps.h"
#include "tests/renderer/view_maps/random_views.h"

namespace lacuna {
namespace {

using test::random_direction;

TEST(Paraboloid, HasEveryDirectionOnce) {
  const Paraboloid map{16};
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (int n = 0; n < 20000; ++n) {
    const V3f d = random_direction(rng) * (0.1F + 5 * rng.next());
    const int texel = map.texel(d);
    ASSERT_TRUE(texel >= 0 && texel < map.texels());
    // Not further from the texel's middle than half its diagonal, by the map's own measure.
    const V3f w = map.direction(texel);
    const float angle = std::acos(std::min(1.0F, w.dot(d.normalized())));
    EXPECT_LT(angle * map.stretch(std::abs(w.x)), std::sqrt(0.5F) * 1.1F) << d;
  }
  for (int t = 0; t < map.texels(); ++t) {
    EXPECT_NEAR(map.direction(t).length(), 1, 1e-6);
    const auto place = map.coord(map.direction(t));
    if (place.half == t / 256) {
      EXPECT_EQ(map.texel(map.direction(t)), t);
    }
  }
}

TEST(Paraboloid, EightAtATimeAreAsOne) {
  for (const int size : {8, 16, 21}) {
    const Paraboloid map{size};
    Rng rng(2, 0, 0, Rng::Purpose::test);
    for (int n = 0; n < 500; ++n) {
      alignas(32) std::array<float, 8> x, y, z;
      alignas(32) std::array<int, 8> texels;
      for (std::size_t i = 0; i < 8; ++i) {
        const V3f d = random_direction(rng) * (0.1F + 5 * rng.next());
        x[i] = d.x, y[i] = d.y, z[i] = d.z;
      }
      const Float8x3 d{Float8::load(x.data()), Float8::load(y.data()), Float8::load(z.data())};
      map.texel(map.coords(d, sqrt(length2(d)))).store(texels.data());
      for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(texels[i], map.texel(V3f(x[i], y[i], z[i])));
    }
  }
}

TEST(Paraboloid, KnowsWhatCoversTheMiddleOfATexel) {
  const Paraboloid map{16};
  Rng rng(5, 0, 0, Rng::Purpose::test);
  int covered = 0;
  for (int n = 0; n < 20000; ++n) {
    const V3f d = random_direction(rng) * (1 + 3 * rng.next());
    const float radius = 0.1F * rng.next();
    const V3f middle = map.direction(map.texel(d));
    const float angle = std::acos(std::min(1.0F, middle.dot(d) / d.length()));
    const float sphere = radius / d.length();  // small
    const Float8x3 eight{d.x, d.y, d.z};
    const auto places = map.coords(eight, Float8(d.length()));
    const bool said = movemask(map.covers_middle(places, radius)) == 0xff;
    covered += said;
    // The map is conformal, but for its stretch, which changes a little within a texel.
    if (std::abs(angle / sphere - 1) > 0.1F) {
      EXPECT_EQ(said, angle < sphere) << d << " " << radius;
    }
  }
  EXPECT_GT(covered, 1000);
  EXPECT_LT(covered, 18000);
}

// A texel is asked for if its square, and so not only its middle, meets the disk.
TEST(Paraboloid, LeavesOutTheCornersOfTheSquares) {
  for (const int size : {8, 16, 21}) {
    const Paraboloid map{size};
    std::vector<bool> asked(static_cast<std::size_t>(map.texels()));
    Rng rng(3, 0, 0, Rng::Purpose::test);
    for (int n = 0; n < 2000000; ++n)
      asked[static_cast<std::size_t>(map.texel(random_direction(rng)))] = true;
    int unmet = 0;  // a square that meets the disk in a tip only
    for (int t = 0; t < map.texels(); ++t) {
      EXPECT_LE(asked[static_cast<std::size_t>(t)], map.reachable(t)) << t;
      unmet += map.reachable(t) && !asked[static_cast<std::size_t>(t)];
    }
    EXPECT_LE(unmet, 16) << "of " << map.texels();
  }
}

// The rectangles of a cap have all texels whose middles lie in it, and few more than its image.
TEST(Paraboloid, FindsCaps) {
  const Paraboloid map{16};
  Rng rng(4, 0, 0, Rng::Purpose::test);
  std::size_t inside = 0, held = 0;
  for (int n = 0; n < 3000; ++n) {
    const V3f w = random_direction(rng);
    const float angle = rng.next() * pi / 2;
    const float cosine = std::cos(angle);
    for (int half = 0; half < 2; ++half) {
      const Paraboloid::Rectangle r = map.cap(half, w, cosine, std::sin(angle));
      held += static_cast<std::size_t>((r.v_end - r.v_first) * (r.u_end - r.u_first));
      for (int t = half * 256; t < half * 256 + 256; ++t) {
        const bool corner = map.coord(map.direction(t)).half != half;
        if (corner || map.direction(t).dot(w) < cosine) continue;
        ++inside;
        const int v = t / 16 % 16, u = t % 16;
        EXPECT_TRUE(v >= r.v_first && v < r.v_end && u >= r.u_first && u < r.u_end) << t;
      }
    }
  }
  EXPECT_LT(double(held), 3 * double(inside));
}

// A leaf nearby fills exactly the texels whose middles its sphere covers, in maps of any size, and
// none of a view within its cube.

}  // namespace
}  // namespace lacuna
