// What Russian roulette goes by, at any vertex of a walk.

#include <gtest/gtest.h>

#include "renderer/path/eye_batch.h"
#include "tests/renderer/path/sided_directions.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna::test {
namespace {

/// A closed room of one grey, seen from within.
SceneData grey_room() {
  SceneParts p;
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(diffuse(Rgb(0.9F))));
  p.eye({0.3, -0.1, 0.9}, {-0.1, -0.2, -1}, 1.5);
  return std::move(p.data);
}

// While a guide does not know what light to expect, a path whose throughput falls below a third of
// what it was at its first vertex is ended or raised to that third; above it, nothing happens.
// Splitting keeps what the guide adds to the weight below 5/3 times that.
/// The least and the largest ratio of a path's throughput, after its third vertex, to that at its
/// first; and how many branches there are.
struct Throughputs {
  float least = 1, most = 0;
  std::size_t branches = 0;
};
Throughputs throughputs(GuidedRoulette roulette) {
  constexpr int max_depth = 8;
  const SceneData data = grey_room();
  ThreadPool pool(1);
  const Scene scene(grey_room(), {.materials = true}, std::nullopt, pool);
  const Camera camera(data.cameras.front(), 8, 8);
  EyeBatch batch(max_depth);
  for (std::size_t i = 0; i < EyeBatch::size; ++i) {
    Rng rng(7, 0, i, Rng::Purpose::test);
    const float x = 8 * rng.next();
    batch.start(camera, rng, camera.ray(x, 8 * rng.next()), i);
  }
  const Guide guide(std::make_unique<SidedDirections>(), nullptr, roulette);
  Counters counters;
  Walk walk(scene, guide, {.max_depth = max_depth, .roulette_depth = 1}, counters);
  int checked = 0;
  Throughputs found;
  walk.trace_paths(batch.states, [&](std::size_t i, int depth) {
    if (depth < 3) return;
    // One more draw of the guide has followed: its weight is 0.9 over the density's ratio.
    const PathState& w = batch.states[i];
    const float ratio = luminance(w.throughput) / luminance(batch.vertex(i, 1).throughput);
    found.least = std::min(found.least, ratio);
    found.most = std::max(found.most, ratio);
    ++checked;
  });
  EXPECT_GT(checked, 30);
  found.branches = walk.branches().size();
  return found;
}

TEST(Roulette, KeepsGuidedPathsInTheWindow) {
  const Throughputs found = throughputs(GuidedRoulette::window);
  EXPECT_LT(found.least, 0.6F) << "the guide favoured nothing";
  EXPECT_LT(found.most, 5.0F / 3 * 1.5F * 2) << "none was split";
  EXPECT_GT(found.branches, 0U);
}

TEST(Roulette, ByThroughputSplitsNothing) {
  const Throughputs found = throughputs(GuidedRoulette::throughput);
  EXPECT_EQ(found.branches, 0U);
  EXPECT_GT(found.most, 5.0F / 3 * 1.5F * 2) << "the window would have kept it";
}

}  // namespace
}  // namespace lacuna::test
