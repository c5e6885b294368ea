// The number of continuations: against brute force, and where rare paths are most of the noise.

#include "renderer/guides/efficiency_roulette.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

/// A pixel: one sample of a part that nothing changes, and a path of throughput T that goes on.
struct Toy {
  double variance, rays;                         // of the part
  double throughput, mean, square, rays_behind;  // and of one continuation

  /// Of `q` continuations: roulette below 1, `q` independent parts above it.
  double variance_of(double q) const {
    const double of_one = square - mean * mean;
    const double behind = q < 1 ? square / q - mean * mean : of_one / q;
    return variance + throughput * throughput * behind;
  }
  double rays_of(double q) const { return rays + q * rays_behind; }
  double expense(double q) const { return variance_of(q) * rays_of(q); }

  /// The fixed point of what EfficiencyRoulette advises.
  double advised() const {
    double q = 1;
    for (int i = 0; i < 200; ++i) {
      const double weight = throughput * std::sqrt(rays_of(q) / variance_of(q));
      const auto w = static_cast<float>(weight);
      q = double(EfficiencyRoulette::continuations(
          {static_cast<float>(mean), static_cast<float>(square), static_cast<float>(rays_behind)},
          w, w));
    }
    return q;
  }
  double best(double from, double to) const {
    double q = from;
    for (double x = from; x <= to; x += 1e-4) q = expense(x) < expense(q) ? x : q;
    return q;
  }
};

TEST(EfficiencyRoulette, AdvisesWhatBruteForceFinds) {
  for (const double square : {0.4, 1.0, 2.0}) {
    for (const double rays_behind : {2.0, 6.0}) {
      const Toy ends{4, 3, 1, 0.5, square, rays_behind};
      const double best = ends.best(1.0 / 3, 0.999);
      EXPECT_NEAR(ends.advised(), best, 2e-3) << square << ", " << rays_behind;
      EXPECT_LT(best, 0.95) << "the toy tells nothing";
    }
  }
  for (const double square : {40.0, 100.0}) {
    const Toy splits{30, 8, 1.5, 3, square, 2};
    const double best = splits.best(1, 7.9);
    EXPECT_NEAR(splits.advised(), best, 2e-3) << square;
    EXPECT_GT(best, 1.6) << "the toy tells nothing";
  }
}

/// What it has learned from eight iterations in which paths went on at one vertex and gathered
/// about as much as the pixels' deviation, while one pixel met `rare` in the first of each four.
float continuations_beside(float rare, float throughput) {
  constexpr int side = 16;
  const ThreadPool pool(1);
  const Scene scene(test::load({"cornell"}), {}, {}, pool);
  const Camera camera(scene.data().cameras.front(), side, side);
  Vertex v;
  v.surface.x = V3f((scene.bounds().low + scene.bounds().high) / 2);
  v.surface.ng = v.wp = V3f(0, 1, 0);
  EfficiencyRoulette roulette(scene, std::size_t{side} * side);
  const std::function<bool()> never = [] { return false; };
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (std::uint64_t i = 0; i < 8; ++i) {
    Image image(side, side);
    for (Rgb& pixel : image.pixels) pixel = Rgb(rng.next() < 0.5F ? 1.0F : 3.0F);
    if (i % 4 == 0) image.pixels[77] = Rgb(rare);
    std::array<EfficiencyRoulette::Accumulator, 1> all;
    for (int k = 0; k < 1000; ++k) {
      all[0].push_back({.cell = roulette.key(v, 4), .rays = 4, .value = k % 2 == 0 ? 0 : 1.4});
    }
    roulette.update(all, {scene, camera, pool, 1, i, never}, image,
                    {.samples = image.pixels.size(), .rays = 4 * image.pixels.size()});
  }
  return roulette.continuations(v, 4, throughput);
}

// A pixel that one path has made the whole noise of the picture tells nothing of what the others
// need: paths end as often as without it, and are not split for it.
TEST(EfficiencyRoulette, RarePathsEndNoOthers) {
  const float usual = continuations_beside(1, 0.7F);
  EXPECT_LT(usual, 0.95F) << "the test has no power";
  EXPECT_GT(usual, 0.5F) << "the test has no power";
  EXPECT_NEAR(continuations_beside(1e4F, 0.7F), usual, 0.1F);
  EXPECT_GT(continuations_beside(1, 30), 4) << "the test has no power";
  EXPECT_EQ(continuations_beside(1e4F, 30), 1);
}

/// After eight iterations whose samples are spread: of each pixel, two of a half have the mean 2,
/// give or take `noise`, with `rays` a sample in the last four.
EfficiencyRoulette of_spread_samples(float noise, std::uint64_t rays) {
  constexpr int side = 16;
  const ThreadPool pool(1);
  const Scene scene(test::load({"cornell"}), {}, {}, pool);
  const Camera camera(scene.data().cameras.front(), side, side);
  EfficiencyRoulette roulette(scene, std::size_t{side} * side);
  const std::function<bool()> never = [] { return false; };
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (std::uint64_t i = 0; i < 8; ++i) {
    const bool tried = i >= 4;
    Image image(side, side);
    for (Rgb& pixel : image.pixels) {
      const float jitter = (rng.next() - 0.5F) * (tried ? noise : 0.5F);
      pixel = Rgb((i % 4 < 2 ? 1.0F : 3.0F) + jitter);
    }
    EXPECT_EQ(roulette.ends_early(), tried);
    roulette.update(
        {}, {scene, camera, pool, 1, i, never}, image,
        {.samples = image.pixels.size(), .rays = (tried ? rays : 6) * image.pixels.size()});
  }
  EXPECT_FALSE(roulette.active());
  EXPECT_FALSE(roulette.learns());
  EXPECT_FALSE(roulette.observes());
  return roulette;
}

// Where samples are spread, roulette by throughput is tried, and stays where it saves more than it
// adds.
TEST(EfficiencyRoulette, EndsPathsEarlyWhereThatPays) {
  EXPECT_TRUE(of_spread_samples(0.5F, 4).ends_early());
  EXPECT_FALSE(of_spread_samples(0.5F, 8).ends_early());
  EXPECT_FALSE(of_spread_samples(1, 4).ends_early())
      << "a third fewer rays for four times the noise";
}

TEST(EfficiencyRoulette, IsBounded) {
  EXPECT_EQ(EfficiencyRoulette::continuations({0, 0, 3}, 1, 1),
            EfficiencyRoulette::continuations({1e-6F, 1e-12F, 3}, 1, 1));
  EXPECT_GT(EfficiencyRoulette::continuations({0, 0, 3}, 1, 1), 0.2F);
  EXPECT_LE(EfficiencyRoulette::continuations({1, 1e20F, 3}, 1, 1), 16);
  // What has no variance is never split, whatever it gathers.
  EXPECT_EQ(EfficiencyRoulette::continuations({1e3F, 1e6F, 3}, 1, 1), 1);
}

}  // namespace
}  // namespace lacuna
