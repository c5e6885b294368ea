// What guides are for: less noise where light comes round corners, and little more where it does
// not. The bounds lie between what was seen and what faults in learning make of it.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/render.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

/// Standard deviation of a pixel's estimate, mean over the picture: the root weighs bright paths
/// that are met once less.
double noise(const char* scene, const GuideSettings& guide, int roulette_depth = 6) {
  PathSettings path = test::path_tracing(6);
  path.roulette_depth = roulette_depth;
  path.guide = guide;
  const test::Rendering r = test::render(
      test::load({scene}), {.integrator = path, .width = 24, .height = 16, .iterations = 256});
  double sum = 0;
  for (const double v : r.film.variance_of_mean()) sum += std::sqrt(v);
  return sum;
}

GuideSettings skeleton(const AutoNumber& strength, const AutoNumber& probability) {
  SkeletonGuideSettings s;
  s.strength = strength;
  s.probability = probability;
  return s;
}

TEST(GuideGain, RoundCorners) {
  const double plain = noise("bends", BsdfGuideSettings{});
  const auto gain = [&](const GuideSettings& guide) { return noise("bends", guide) / plain; };
  EXPECT_LT(gain(skeleton({8}, {0.5})), 0.65);
  EXPECT_LT(gain(skeleton({}, {0.5})), 0.6);
  EXPECT_LT(gain(skeleton({8}, {})), 0.65);
  EXPECT_LT(gain(skeleton({}, {})), 0.6);
  EXPECT_LT(gain(FaceIrradianceGuideSettings{}), 0.9);
  EXPECT_LT(gain(test::in_small_pictures(SdTreeGuideSettings{})), 0.8);
}

// A guided path has little throughput: roulette by it would end just what the guide is for.
TEST(GuideGain, IsNotLostToRoulette) {
  const double plain = noise("bends", BsdfGuideSettings{}, 2);
  EXPECT_LT(noise("bends", skeleton({8}, {0.5}), 2) / plain, 0.85);
}

// With the lamp in sight lobes can only cost.
TEST(GuideGain, WhatIsLearnedDoesNoHarm) {
  for (const char* scene : {"cornell", "atrium"}) {
    SCOPED_TRACE(scene);
    const double plain = noise(scene, BsdfGuideSettings{});
    EXPECT_GT(noise(scene, skeleton({32}, {0.5})) / plain, 1.1) << "the test has no power";
    EXPECT_LT(noise(scene, skeleton({}, {})) / plain, 1.05);
    EXPECT_LT(noise(scene, PortalsGuideSettings{}) / plain, 1.02);
    EXPECT_LT(noise(scene, FaceIrradianceGuideSettings{}) / plain, 1.05);
  }
}

}  // namespace
}  // namespace lacuna
