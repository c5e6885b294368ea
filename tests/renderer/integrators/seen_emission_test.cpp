// Rays of their own for the borders of emitters that a pixel sees: the same picture as one sample
// of each path, with less noise, for few rays.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::PathScene;
using test::Rendering;
using test::RenderSettings;

/// Paths of one edge, of a method that takes one sample of what a pixel sees.
ManyLightsSettings one_sample() {
  ManyLightsSettings s = test::of_length(ManyLightsSettings{}, 1);
  s.light_paths = 1;
  return s;
}

RenderSettings seen_picture(const PathScene& scene, const IntegratorSettings& integrator) {
  return {.integrator = integrator,
          .width = 48,
          .height = 40,
          .iterations = 400,
          .environment = environment(scene)};
}

double variance(const Rendering& r) {
  double sum = 0;
  for (const double v : r.film.variance_of_mean()) sum += v;
  return sum;
}

TEST(SeenEmission, HasThePictureOfOneSample) {
  for (const PathScene& scene : {PathScene{"many_lights"}, PathScene{"open", true}}) {
    for (const PixelFilter filter : {PixelFilter::box, PixelFilter::tent}) {
      SCOPED_TRACE(scene.name);
      RenderSettings s = seen_picture(scene, one_sample());
      s.filter = filter;
      s.iterations *= 4;
      const Rendering simple = test::render(test::load(scene), s);
      s = seen_picture(scene, test::path_tracing(1));
      s.filter = filter;
      s.seed = 2;
      test::expect_same_picture(test::render(test::load(scene), s), simple, 0.06);
    }
  }
}

// A border gets sixteen rays, and where no other pixel has noise that is a sixteenth of it.
TEST(SeenEmission, SavesTheNoiseOfBorders) {
  const PathScene scene{"cornell"};
  const double simple =
      variance(test::render(test::load(scene), seen_picture(scene, one_sample())));
  RenderSettings s = seen_picture(scene, test::path_tracing(1));
  EXPECT_LT(variance(test::render(test::load(scene), s)), simple / 13);
  s.sampler = Sampler::sobol;
  // Of sixteen points that are spread, and the sixteenth part of the rest: far less.
  EXPECT_LT(variance(test::render(test::load(scene), s)), simple / 13);
}

// Lamps smaller than a pixel, which few rays find, are known by their corners.
TEST(SeenEmission, KnowsLampsSmallerThanAPixel) {
  const PathScene scene{"many_lights"};
  RenderSettings s = seen_picture(scene, one_sample());
  s.width = 192, s.height = 108, s.iterations = 100;
  const Rendering simple = test::render(test::load(scene), s);
  s.integrator = test::path_tracing(1);
  EXPECT_LT(variance(test::render(test::load(scene), s)), variance(simple) / 4);
}

// Under a sky that varies everywhere, too, rays cost at most half of one a pixel.
TEST(SeenEmission, CostsAtMostHalfARayAPixel) {
  for (const PathScene& scene :
       {PathScene{"cornell"}, PathScene{"many_lights"}, PathScene{"open", true}}) {
    SCOPED_TRACE(scene.name);
    const RenderSettings s = seen_picture(scene, test::path_tracing(1));
    const Rendering r = test::render(test::load(scene), s);
    const double pixels = double(s.width) * s.height * s.iterations;
    EXPECT_GT(double(r.counters.rays), pixels);
    EXPECT_LE(double(r.counters.rays), 1.5 * pixels);
  }
}

}  // namespace
}  // namespace lacuna
