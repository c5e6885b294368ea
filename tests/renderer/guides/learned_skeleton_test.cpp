// What guides along the skeleton learn from which vertices.

#include "renderer/guides/learned_skeleton.h"

#include <gtest/gtest.h>

#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::GuidedScene;

// Light comes from one side at every fourth vertex, from the other at the three between.
TEST(LearnedSkeleton, LobesLearnFromAllLitVertices) {
  LearnedSkeletonGuideSettings settings;
  settings.probability = {0.5};
  GuidedScene scene([] { return load_gltf(test::own_scene("ajar.glb")); }, settings, 0, {}, 48);
  const std::vector<Vertex> found = scene.guided_vertices(1);
  ASSERT_EQ(found.size(), 1);
  Vertex v = found.front();
  const V3f n = v.side();
  const V3f along = std::abs(n.x) < 0.5F ? V3f(1, 0, 0) : V3f(0, 1, 0);
  const V3f across = (along - n * dot(along, n)).normalized();
  const V3f seldom = (n + across).normalized(), often = (n - across).normalized();

  const auto guide = make_guiding_distribution(settings);
  guide->prepare(scene.context());
  const ThreadPool pool(1);
  for (int round = 0; round < 6; ++round) {
    v.guiding_cell = guide->cell(v.surface, v.wp);
    TrainingSamples::Part part;
    for (int i = 0; i < 400; ++i) {
      part.push_back({.cell = v.guiding_cell,
                      .x = v.surface.x,
                      .n = n,
                      .w = i % 4 == 0 ? seldom : often,
                      .distance = 1,
                      .cosine = 1,
                      .pdf = 0.1F,
                      .radiance = 1});
    }
    for (int k = 0; k < 1 << round; ++k) {
      guide->update(TrainingSamples(std::span(&part, 1), guide->cells(), pool), pool);
    }
  }
  v.guiding_cell = guide->cell(v.surface, v.wp);
  const GuidedVertex at{v.surface, *v.bsdf, v.wp, v.guiding_cell};
  EXPECT_GT(guide->pdf(at, often).value, guide->pdf(at, seldom).value);
}

// Light from the axis of a lobe alone: the narrowest strength gains all weight but its given share,
// which makes the density there a multiple of that of ten equal weights.
TEST(SkeletonDirections, StrengthFollowsTheLight) {
  SkeletonGuideSettings settings;
  settings.strength = {};
  GuidedScene scene([] { return load_gltf(test::own_scene("ajar.glb")); }, settings, 0, {}, 48);
  const std::vector<Vertex> found = scene.guided_vertices(1);
  ASSERT_EQ(found.size(), 1);
  const Vertex& v = found.front();
  const auto guide = make_guiding_distribution(settings);
  guide->prepare(scene.context());
  const GuidedVertex at{v.surface, *v.bsdf, v.wp, v.guiding_cell};
  Rng rng(3, 0, 0, Rng::Purpose::test);
  V3f axis = v.side();
  for (int i = 0; i < 5000; ++i) {
    const auto w = guide->sample(at, rng.next_fine_point(), rng);
    if (w && guide->pdf(at, *w).value > guide->pdf(at, axis).value) axis = *w;
  }
  const float before = guide->pdf(at, axis).value;
  const TrainingSamples::Part part(100, {.cell = v.guiding_cell,
                                         .x = v.surface.x,
                                         .n = v.side(),
                                         .w = axis,
                                         .pdf = 1,
                                         .reflected = 1});
  const ThreadPool pool(1);
  for (int i = 0; i < 20; ++i) {
    guide->update(TrainingSamples(std::span(&part, 1), guide->cells(), pool), pool);
  }
  EXPECT_GT(guide->pdf(at, axis).value, 3 * before);
}

}  // namespace
}  // namespace lacuna
