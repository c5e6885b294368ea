// The light that arrives along single rays, in rooms where it is known.

#include "renderer/guides/face_paths.h"

#include <gtest/gtest.h>

#include "tests/renderer/scene/scene_parts.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

// In a closed room of grey that emits 1 everywhere, each edge adds its albedo to the last one's.
TEST(FacePaths, FindTheLightOfAGlowingRoom) {
  constexpr float albedo = 0.5F;
  Material glow = test::diffuse(Rgb(albedo));
  glow.emission = Rgb(1);
  test::SceneParts p;
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(glow));
  p.eye({0.3, -0.1, 0.9}, {-0.1, -0.2, -1}, 1.5);
  const Camera camera(p.data.cameras.front(), 4, 4);
  const Scene scene = test::lit_scene(std::move(p.data));
  const ThreadPool pool(2);
  const std::function<bool()> stop = [] { return false; };
  const IterationContext context{scene, camera, pool, 3, 0, stop};
  const auto ray = [](std::size_t, Rng& rng) -> Ray {
    const V3f to(rng.next() - 0.5F, rng.next() - 0.5F, rng.next() - 0.5F);
    return {V3f(0.1F, 0.2F, -0.3F), to.normalized()};
  };
  std::vector<float> light(1000);
  double expected = 0;
  for (int edges = 1; edges <= 4; ++edges) {
    expected = 1 + double(albedo) * expected;
    std::fill(light.begin(), light.end(), 0.0F);
    const Counters counters = arriving_light(context, edges, ray, light);
    EXPECT_EQ(counters.rays, light.size() * static_cast<std::size_t>(edges));
    statistics::Moments found;
    for (const float l : light) found.add(double(l));
    EXPECT_LE(std::abs(found.mean() - expected), 5 * found.standard_error() + 1e-5) << edges;
    EXPECT_LE(found.standard_error(), 0.05) << edges;
  }
}

}  // namespace
}  // namespace lacuna
