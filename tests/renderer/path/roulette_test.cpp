// What Russian roulette goes by, at any vertex of a walk.

#include <gtest/gtest.h>

#include "renderer/path/eye_batch.h"
#include "tests/renderer/path/sided_directions.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna::test {
namespace {

constexpr int longest = 8;

/// A closed room of one grey, seen from within.
SceneData grey_room() {
  SceneParts p;
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(diffuse(Rgb(0.9F))));
  p.eye({0.3, -0.1, 0.9}, {-0.1, -0.2, -1}, 1.5);
  return std::move(p.data);
}

// On Lambertian walls the BSDF's own draws leave the albedo. So a walk survives with that
// probability at every vertex and carries 1 in front of the next one, by its throughput times its
// scale, wherever the guide sent it: to directions that it favours, where its throughput is far
// less, or elsewhere.
TEST(Roulette, GoesByWhatTheBsdfWouldHaveLeft) {
  const SceneData data = grey_room();
  ThreadPool pool(1);
  const Scene scene(grey_room(), {.materials = true}, std::nullopt, pool);
  const Camera camera(data.cameras.front(), 8, 8);
  EyeBatch batch(longest);
  for (std::size_t i = 0; i < EyeBatch::size; ++i) {
    Rng rng(7, 0, i, Rng::Purpose::test);
    const float x = 8 * rng.next();
    batch.start(camera, rng, camera.ray(x, 8 * rng.next()), i);
  }
  const MixedGuide guide(std::make_unique<SidedDirections>());
  Counters counters;
  Walk<MixedGuide> walk(scene, guide, {.max_depth = longest, .roulette_depth = 1}, counters);
  int told = 0;
  float least = 1;
  walk.trace_paths(
      batch.states, [](std::size_t, int) {},
      [&](std::size_t i, int depth) {
        if (depth < 2) return;
        const PathState& w = batch.states[i];
        const float carried = max_component(w.throughput);
        EXPECT_NEAR(carried * w.roulette_scale, 1.0F, 1e-4F);
        least = std::min(least, carried);
        ++told;
      });
  EXPECT_GT(told, 30);
  EXPECT_LT(least, 0.6F) << "the guide favoured nothing";
}

}  // namespace
}  // namespace lacuna::test
