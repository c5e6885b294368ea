// Power-cosine lobes by themselves, up to strengths that only a grid around each can resolve.

#include "renderer/guides/lobe_set.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/sphere_chi_square.h"

namespace lacuna {
namespace {

constexpr std::array<float, 8> strengths{0, 1e-3F, 0.5F, 1, 8, 100, 1000, 1e4F};

TEST(Power, OfEight) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const float s : strengths) {
    for (int i = 0; i < 2000; ++i) {
      // Also next to 0 and to 1.
      float c = uniform(random);
      if (i % 3 == 1) c = 1 - c * c * c * 1e-3F;
      if (i % 3 == 2) c = std::ldexp(c, -static_cast<int>(random() % 100));
      alignas(32) std::array<float, 8> power{};
      power8(c, s).store(power.data());
      const double expected = std::pow(double(c), double(s));
      // A power of 2^-126 and less is nothing.
      const double rounding =
          (4e-7 + 4e-7 * std::abs(std::log2(expected + 1e-99))) * expected + 1e-37;
      ASSERT_NEAR(double(power[0]), expected, rounding) << c << "^" << s;
      ASSERT_EQ(power[0], power[7]);
    }
    alignas(32) std::array<float, 8> ends{};
    alignas(32) const std::array<float, 8> bases{0, 1, 1e-45F};
    power8(Float8::load(bases.data()), s).store(ends.data());
    EXPECT_EQ(ends[0], 0);
    EXPECT_EQ(ends[1], 1);
    EXPECT_EQ(ends[2], 0);
  }
}

TEST(LobeSet, DrawsWithItsDensity) {
  const double level = statistics::sidak(1e-3, strengths.size());
  const std::array<Target, 3> targets{Target{{3, 1, 0}, 1.0}, Target{{-2, 4, 1}, 5.0},
                                      Target{{0.1F, -0.2F, -7}, 0.3}};
  const LobeSet lobes(targets);
  const V3f x(0.3F, 0.2F, 0.1F);
  for (const float s : strengths) {
    SCOPED_TRACE(s);
    std::vector<statistics::SphereGrid> grids;
    std::vector<V3f> poles;
    for (const Target& t : targets) {
      poles.push_back((t.at - x).normalized());
      grids.emplace_back(poles.back(), 1 / std::sqrt(double(s) + 1));
    }
    const auto nearest = [&](const V3f& w) {
      std::size_t best = 0;
      for (std::size_t i = 1; i < poles.size(); ++i) {
        if (dot(w, poles[i]) > dot(w, poles[best])) best = i;
      }
      return best;
    };
    Rng rng(3, 0, 0, Rng::Purpose::test);
    const auto result = statistics::sphere_chi_square(
        grids, nearest, 50000, [&] { return lobes.sample(x, s, rng); },
        [&](const V3f& w) { return lobes.pdf(x, w, s).value; });
    EXPECT_GT(result.p, level) << result.message;
  }
}

TEST(LobeSet, PowersAreStrengths) {
  std::vector<Target> targets;
  targets.reserve(19);
  for (int i = 0; i < 19; ++i) targets.push_back({V3f(float(i), 3, float(-i * i)), 1.0 + i});
  const LobeSet lobes(targets);
  Rng rng(4, 0, 0, Rng::Purpose::test);
  for (int k = 0; k < 100; ++k) {
    const V3f x(rng.next(), rng.next(), rng.next());
    const auto w = lobes.sample(x, 4, rng);
    ASSERT_TRUE(w);
    const auto powers = lobes.pdf_of_powers(x, *w);
    for (std::size_t i = 0; i < powers.size(); ++i) {
      const float s = float(1U << i), p = lobes.pdf(x, *w, s).value;
      EXPECT_NEAR(powers[i], p, 1e-4F * p + 1e-20F);
      // Of a strength between, which is no power of 2.
      EXPECT_NEAR(lobes.pdf(x, *w, std::nextafter(s, 2 * s)).value, p, 1e-4F * p + 1e-20F);
    }
  }
}

TEST(LobeSet, PointsAtThePlaceItselfAreNowhere) {
  const std::array<Target, 2> targets{Target{{1, 2, 3}, 1.0}, Target{{1, 2, 4}, 3.0}};
  const LobeSet lobes(targets);
  Rng rng(5, 0, 0, Rng::Purpose::test);
  int none = 0;
  for (int i = 0; i < 4000; ++i) none += lobes.sample({1, 2, 3}, 8, rng) ? 0 : 1;
  EXPECT_NEAR(none, 1000, 150);
  EXPECT_NEAR(lobes.pdf({1, 2, 3}, {0, 0, 1}, 8).value, 0.75 * 9 / (2 * std::numbers::pi), 1e-4);
  EXPECT_EQ(lobes.pdf({1, 2, 3}, {0, 0, -1}, 8).value, 0);
  EXPECT_TRUE(LobeSet().empty());
  EXPECT_TRUE(LobeSet(std::span<const Target>()).empty());
}

}  // namespace
}  // namespace lacuna
