// The probability of a test, at and beyond the ends of what it is made of, and the drawing of
// tests.

#include "renderer/visibility/test_probability.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "tests/statistics.h"

namespace lacuna {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

float of(const TestProbability& chance, float t, float var) {
  return _mm256_cvtss_f32(chance.of(t, var).v);
}
std::uint32_t key(float probability, float lit = 1) {
  TestSampler keys;
  keys.set(3, probability, lit);
  return keys.v[24];
}

// Nabata et al., eq. 9: variance times time, by search.
TEST(TestProbability, IsWhereVarianceTimesTimeIsLeast) {
  for (const float t : {0.1F, 0.5F, 1.0F, 2.5F}) {
    for (const float k : {0.001F, 0.05F, 0.3F}) {
      const float var = 0.15F;
      const TestProbability chance{.k = k, .c = 1, .least = 1e-4F, .over_sigma = 1};
      const double a = double(t) * double(t) * double(var);
      double best = 1;
      double least = std::numeric_limits<double>::infinity();
      for (int i = 1; i <= 10000; ++i) {
        const double x = 1e-4 * i;
        const double cost = (1 + a * (1 - x) / x) * (double(k) + x);
        if (cost < least) least = cost, best = x;
      }
      EXPECT_NEAR(double(of(chance, t, var)), best, 2e-3) << t << " " << k;
    }
  }
}

TEST(TestProbability, AtItsEnds) {
  const TestProbability chance{.k = 0.03F, .c = 1, .least = 0.1F, .over_sigma = 1};
  EXPECT_EQ(of(chance, 0, 0.25F), 0.1F);
  EXPECT_EQ(of(chance, 2, 0.25F), 1.0F) << "A = sigma^2";
  EXPECT_EQ(of(chance, 3, 0.25F), 1.0F) << "A > sigma^2";
  EXPECT_EQ(of(chance, 1e30F, 0.25F), 1.0F);
  EXPECT_EQ(of(chance, 1e-30F, 0.25F), 0.1F);
  const TestProbability constant{.k = 0.03F, .c = 1, .least = 0.1F, .over_sigma = infinite};
  EXPECT_EQ(of(constant, 1, 0.1F), 1.0F) << "sigma^2 = 0";
  EXPECT_EQ(of(constant, 0, 0.1F), 1.0F);
  const TestProbability free{.k = 0, .c = 1, .least = 0.1F, .over_sigma = 1};
  EXPECT_EQ(of(free, 1, 0.1F), 0.1F) << "n_0 = 1";
  const TestProbability veach{.k = 1, .c = 0, .least = 0.001F, .over_sigma = 1};
  EXPECT_FLOAT_EQ(of(veach, 0.4F, 1), 0.4F);
  EXPECT_EQ(of(veach, 1e20F, 1), 1.0F);
}

TEST(TestSampler, HoldTheirEnds) {
  EXPECT_EQ(key(1), TestSampler::one);
  EXPECT_EQ(key(1e-9F), 1U) << "never impossible";
  EXPECT_EQ(key(1, 0), 0U) << "gives nothing";
}

// Each light is drawn with its own probability, whatever those beside it have.
TEST(TestSampler, DrawEachWithItsProbability) {
  TestSampler keys{};
  Rng rng(1, 2, 3, Rng::Purpose::test);
  for (int i = 0; i < Lanes::size; ++i) {
    keys.v[static_cast<std::size_t>(i)] = i % 7 == 0 ? 0 : key(rng.next());
  }
  keys.v[5] = TestSampler::one;
  keys.v[11] = 1;
  double mean = 0, variance = 0;  // of the number that are drawn, if each is by itself
  for (const std::uint32_t v : keys.v) {
    const double p = double(v) / TestSampler::one;
    mean += p, variance += p * (1 - p);
  }
  constexpr int draws = 200000;
  for (const TestDraws how : {TestDraws::systematic, TestDraws::bernoulli}) {
    SCOPED_TRACE(enum_name(how));
    std::array<int, Lanes::size> drawn{};
    double squares = 0;
    for (int n = 0; n < draws; ++n) {
      const std::uint64_t bits = keys.sample(how, rng);
      for (int i = 0; i < Lanes::size; ++i) drawn[static_cast<std::size_t>(i)] += bits >> i & 1;
      const double off = std::popcount(bits) - mean;
      squares += off * off;
    }
    for (int i = 0; i < Lanes::size; ++i) {
      const double p = double(keys.v[static_cast<std::size_t>(i)]) / TestSampler::one;
      const double sd = std::sqrt(draws * p * (1 - p));
      EXPECT_NEAR(drawn[static_cast<std::size_t>(i)], draws * p, 5 * sd) << i;
    }
    if (how == TestDraws::systematic) {
      EXPECT_LT(squares / draws, 1) << "one more or fewer than their mean";
    } else {
      EXPECT_NEAR(squares / draws, variance, 0.05 * variance);
    }
  }
}

}  // namespace
}  // namespace lacuna
