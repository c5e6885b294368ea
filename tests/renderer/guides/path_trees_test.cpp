// What is learned from paths that were split.

#include "renderer/guides/path_trees.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "renderer/path/bsdf_guide.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna::test {
namespace {

/// Splits by three after one edge, and by two after three.
struct SplitsTwice final : Roulette {
  int max_depth;
  explicit SplitsTwice(int longest) : max_depth(longest) {}
  float continuations(const Vertex&, int edges_left, float) const override {
    const int depth = max_depth - edges_left;
    if (depth == 1) return 3;
    return depth == 3 ? 2 : 1;
  }
};

// In a closed room of one grey each vertex scatters .9 of its light whatever the direction. Where
// every vertex adds its throughput, all continuations from one depth gather the same.
TEST(PathTrees, AContinuationHasTheLightAndTheRaysOfAllBranchesBehindIt) {
  constexpr int max_depth = 4;
  constexpr double albedo = 0.9;
  SceneParts p;
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(diffuse(Rgb(float(albedo)))));
  p.eye({0.3, -0.1, 0.9}, {-0.1, -0.2, -1}, 1.5);
  ThreadPool pool(1);
  const Camera camera(p.data.cameras.front(), 8, 8);
  const Scene scene(std::move(p.data), {.materials = true}, std::nullopt, pool);
  EyeBatch batch(max_depth);
  for (std::size_t i = 0; i < EyeBatch::size; ++i) {
    batch.start(camera, Rng(7, 0, i, Rng::Purpose::test), camera.ray(float(i % 8), float(i) / 8),
                i);
  }
  Counters counters;
  const BsdfGuide guide;
  const SplitsTwice roulette(max_depth);
  Walk<BsdfGuide> walk(scene, guide,
                       {.max_depth = max_depth, .roulette_depth = max_depth, .roulette = &roulette},
                       counters);
  GatheredLight gathered(batch);
  PathTrees trees;
  do {
    gathered.clear();
    trees.begin(batch.states);
    walk.trace_paths(
        batch.states, [](std::size_t, int) {},
        [&](std::size_t i, int depth) {
          gathered.reach(i, depth);
          gathered.add(i, depth, batch.vertex(i, depth).throughput);
        });
    trees.collect(batch, gathered,
                  [](const Vertex&, int depth) { return static_cast<std::uint32_t>(depth); });
    batch.store(walk.branches());
  } while (batch.resume());

  std::map<std::uint32_t, std::size_t> continuations;
  trees.record([&](std::uint32_t depth, double value, double rays) {
    ++continuations[depth];
    double light = 0;
    for (int k = 1; k <= max_depth - int(depth); ++k) light += std::pow(albedo, k);
    EXPECT_NEAR(value, light, 1e-5) << "at depth " << depth;
    // To the vertices 2 and 3, and in two branches to the last.
    EXPECT_EQ(rays, depth == 1 ? 4 : depth == 2 ? 3 : 1) << "at depth " << depth;
  });
  constexpr std::size_t n = EyeBatch::size;
  EXPECT_EQ(continuations,
            (std::map<std::uint32_t, std::size_t>{{1, 3 * n}, {2, 3 * n}, {3, 6 * n}}));
}

}  // namespace
}  // namespace lacuna::test
