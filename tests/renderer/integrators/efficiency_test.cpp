// Path tracing with efficiency-aware roulette and splitting: the same picture as without, and the
// same bits for any number of threads and after a pause.

#include <cmath>

#include "renderer/guides/efficiency_roulette.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::Rendering;
using test::RenderSettings;

PathSettings efficient(PathLengths lengths, const GuideSettings& guide = BsdfGuideSettings{}) {
  PathSettings path{lengths};
  path.guide = guide;
  path.roulette = RouletteChoice::efficiency;
  return path;
}
/// Every guide that walks in a way of its own, and none.
std::vector<GuideSettings> some_guides() {
  return {BsdfGuideSettings{}, test::in_small_pictures(SkeletonGuideSettings{}),
          test::in_small_pictures(SdTreeGuideSettings{})};
}

struct LitRoom {
  const char* scene;
  int iterations;
};

// Whole paths and those that are ended and split are estimates of one picture, block by block, with
// glass and mirrors, too.
TEST(Efficiency, RouletteChangesNothing) {
  int active = 0;
  for (const auto& [scene, iterations] :
       {LitRoom{"cornell", 200}, LitRoom{"glass", 300}, LitRoom{"mirror", 200},
        LitRoom{"area", 200}, LitRoom{"ajar", 400}}) {
    SCOPED_TRACE(scene);
    RenderSettings s{.integrator = test::path_tracing(8), .iterations = iterations};
    const test::PathScene shown{scene};
    const Rendering expected = test::render(test::load(shown), s);
    s.seed = 2;
    s.integrator = efficient(test::whole_paths(8));
    const Rendering found = test::render(test::load(shown), s);
    test::expect_same_picture(found, expected, 0.1);
    // Beyond what differs by chance.
    const double rays = double(found.counters.rays) / double(expected.counters.rays);
    active += std::abs(std::log(rays)) > 0.02 ? 1 : 0;
  }
  EXPECT_GE(active, 3) << "it decides nothing";
}

TEST(Efficiency, GuidedPathsHaveThePictureOfOthers) {
  const test::PathScene shown{"ajar"};
  RenderSettings s{.integrator = test::path_tracing(6), .iterations = 300};
  const Rendering expected = test::render(test::load(shown), s);
  s.seed = 2;
  for (const GuideSettings& guide : some_guides()) {
    SCOPED_TRACE(std::visit([](const auto& g) { return std::string(g.name); }, guide));
    s.integrator = efficient(test::whole_paths(6), guide);
    test::expect_same_picture(test::render(test::load(shown), s), expected, 0.1);
  }
}

TEST(Efficiency, BitsDoNotDependOnThreads) {
  for (const GuideSettings& guide : some_guides()) {
    RenderSettings s{.integrator = efficient({.max_depth = 6}, guide),
                     .width = 70,
                     .height = 45,
                     .iterations = 14};
    s.threads = 1;
    const Rendering one = test::render("ajar.glb", s);
    s.threads = 2;
    const Rendering two = test::render("ajar.glb", s);
    EXPECT_EQ(one.film.mean(), two.film.mean());
    EXPECT_EQ(one.counters.rays, two.counters.rays);
    PathSettings plain{PathLengths{.max_depth = 6}};
    plain.guide = guide;
    s.integrator = plain;
    EXPECT_NE(test::render("ajar.glb", s).counters.rays, one.counters.rays) << "it decides nothing";
  }
}

// Before it decides anything, while it is on trial, and when it stays.
TEST(Efficiency, GoesOnAfterAPause) {
  constexpr std::uint64_t iterations = 20;
  for (const std::uint64_t pause : {2U, 6U, 13U}) {
    const auto start = [] {
      return std::make_unique<test::Session>(
          load_gltf(test::own_scene("ajar.glb")),
          RenderSettings{.integrator = efficient({.max_depth = 6}), .width = 24, .height = 20});
    };
    const auto straight = start();
    ByteWriter saved, at_end, resumed_at_end;
    std::vector<Image> expected;
    for (std::uint64_t i = 0; i < iterations; ++i) {
      if (i == pause) straight->integrator().save(saved);
      expected.push_back(straight->iterate(i));
    }
    const auto resumed = start();
    ByteReader in(saved.bytes());
    resumed->integrator().load(in);
    EXPECT_TRUE(in.at_end());
    for (std::uint64_t i = pause; i < iterations; ++i) {
      EXPECT_EQ(resumed->iterate(i).pixels, expected[i].pixels) << "iteration " << i;
    }
    straight->integrator().save(at_end);
    resumed->integrator().save(resumed_at_end);
    EXPECT_EQ(at_end.bytes(), resumed_at_end.bytes());
  }
}

TEST(Efficiency, AnotherPicturesStateIsRefused) {
  const auto start = [](int width) {
    return std::make_unique<test::Session>(
        load_gltf(test::own_scene("ajar.glb")),
        RenderSettings{.integrator = efficient({}), .width = width, .height = 20});
  };
  ByteWriter saved;
  start(24)->integrator().save(saved);
  ByteReader in(saved.bytes());
  EXPECT_THROW(start(25)->integrator().load(in), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
