// One picture, however it is made: with and without next event estimation, roulette, threads,
// scale, place.

#include <gtest/gtest.h>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/integrators/render.h"
#include "tests/renderer/integrators/transformed.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::own_scene;
using test::render;
using test::Rendering;
using test::RenderSettings;
using test::transformed;

/// The means of two pictures differ by no more than their noise.
void expect_same_mean(const Rendering& a, const Rendering& b) {
  const double deviation = std::sqrt(a.variance_of_mean() + b.variance_of_mean());
  EXPECT_NEAR(a.mean(), b.mean(), 4.5 * deviation);
  EXPECT_LT(deviation, 0.03 * b.mean()) << "the test has no power";
  EXPECT_EQ(a.counters.rejected + b.counters.rejected, 0U);
}

RenderSettings with(PathSettings path, int iterations, std::uint64_t seed = 1) {
  RenderSettings s{.integrator = path};
  s.iterations = iterations;
  s.seed = seed;
  return s;
}

class EveryScene : public testing::TestWithParam<const char*> {};

// Hitting the emitter alone is the plainest estimator there is: it has no weights, no emitter
// sampling. The scenes have emitters large enough for it.
TEST_P(EveryScene, NextEventEstimationChangesNothing) {
  PathSettings nee;
  PathSettings plain;
  plain.next_event_estimation = false;
  expect_same_mean(render(GetParam(), with(nee, 256)), render(GetParam(), with(plain, 1024, 2)));
}

TEST_P(EveryScene, RouletteChangesNothing) {
  PathSettings early;
  early.max_depth = 10;
  early.roulette_depth = 1;
  PathSettings never;
  never.max_depth = 10;
  never.roulette_depth = 1024;
  expect_same_mean(render(GetParam(), with(early, 400)), render(GetParam(), with(never, 256, 2)));
}

INSTANTIATE_TEST_SUITE_P(Path, EveryScene,
                         testing::Values("cornell.glb", "furnace_sphere.glb", "glass.glb",
                                         "area.glb"),
                         [](const auto& scene) {
                           const std::string name = scene.param;
                           return name.substr(0, name.find('.'));
                         });

TEST(Environment, NextEventEstimationChangesNothing) {
  RenderSettings nee{.iterations = 256};
  nee.environment = EnvironmentImage{own_scene("sky.hdr"), 1, 0.7F};
  RenderSettings plain = nee;
  PathSettings p;
  p.next_event_estimation = false;
  plain.integrator = p;
  plain.iterations = 4096;
  plain.seed = 2;
  expect_same_mean(render("open.glb", nee), render("open.glb", plain));
}

TEST(Bits, DoNotDependOnThreads) {
  for (const char* scene : {"ajar.glb", "atrium.glb", "many_lights.glb"}) {
    RenderSettings s{.width = 70, .height = 45, .iterations = 2};
    s.threads = 1;
    const Rendering one = render(scene, s);
    s.threads = 64;  // more than there are cores
    const Rendering many = render(scene, s);
    EXPECT_EQ(one.film.mean(), many.film.mean()) << scene;
    EXPECT_EQ(one.film.variance_of_mean(), many.film.variance_of_mean()) << scene;
    EXPECT_EQ(one.counters.rays, many.counters.rays) << scene;
  }
}

TEST(Bits, SeedsAndIterationsDiffer) {
  const Rendering a = render("cornell.glb", {.iterations = 1});
  const Rendering b = render("cornell.glb", {.iterations = 1, .seed = 2});
  EXPECT_NE(a.film.mean(), b.film.mean());
  EXPECT_NE(render("cornell.glb", {.iterations = 2}).film.mean(), a.film.mean());
}

// No absolute epsilon anywhere: a power of two only moves exponents, so not a bit may change.
TEST(Extremes, ScaleByPowersOfTwoKeepsEveryBit) {
  for (const char* name : {"cornell.glb", "ajar.glb", "many_lights.glb"}) {
    const RenderSettings s{.width = 40, .height = 40, .iterations = 2};
    const std::vector<double> expected = render(transformed(name, 1, V3d(0)), s).film.mean();
    for (const double scale : {0x1p-14, 0x1p17}) {
      const Rendering r = render(transformed(name, scale, V3d(0)), s);
      const std::vector<double> mean = r.film.mean();
      std::size_t different = 0;
      for (std::size_t i = 0; i < mean.size(); ++i) different += mean[i] != expected[i] ? 1 : 0;
      EXPECT_EQ(different, 0U) << name << " at scale " << scale;
      EXPECT_EQ(r.counters.rejected, 0U);
    }
  }
}

TEST(Extremes, ScaleAndPlaceKeepTheMean) {
  const Rendering here = render("cornell.glb", {.iterations = 256});
  for (const double scale : {1e-4, 1e5}) {
    expect_same_mean(
        render(transformed("cornell.glb", scale, V3d(0)), {.iterations = 256, .seed = 3}), here);
  }
  // Two units of size, a thousand away: coordinates keep 13 bits of the scene.
  expect_same_mean(
      render(transformed("cornell.glb", 1, V3d(1000, -2000, 3000)), {.iterations = 256, .seed = 4}),
      here);
}

TEST(Extremes, BrightnessScalesThePicture) {
  const auto lit = [](float factor) {
    SceneData scene = load_gltf(own_scene("cornell.glb"));
    for (Material& m : scene.materials) m.emission *= factor;
    return render(std::move(scene), {.iterations = 4});
  };
  const std::vector<double> expected = lit(1).film.mean();
  for (const float factor : {0x1p-60F, 0x1p60F}) {
    const Rendering r = lit(factor);
    const std::vector<double> mean = r.film.mean();
    for (std::size_t i = 0; i < mean.size(); ++i) {
      ASSERT_NEAR(mean[i] / double(factor), expected[i], 1e-6 * expected[i] + 1e-12);
    }
    EXPECT_EQ(r.counters.rejected, 0U);
  }
}

TEST(Stop, LeavesNothingBehind) {
  const ThreadPool pool(2);
  const auto integrator = make_integrator(PathSettings{});
  SceneData data = load_gltf(own_scene("cornell.glb"));
  const Camera camera(data.cameras.front(), 64, 64);
  const Scene scene(std::move(data), integrator->needs(), std::nullopt, pool);
  Image image(64, 64);
  std::atomic<int> asked{0};
  const std::function<bool()> soon = [&] { return ++asked > 2; };
  EXPECT_THROW(integrator->iterate({scene, camera, pool, 1, 0, soon}, image), IterationStopped);
}

}  // namespace
}  // namespace lacuna
