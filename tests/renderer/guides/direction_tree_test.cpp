// The quadtree of directions, and the state that guides keep.

#include "renderer/guides/direction_tree.h"
#include "renderer/gltf/gltf_load.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/renderer/guides/density_check.h"
#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/integrators/methods.h"

namespace lacuna {
namespace {

V3f around(const V3f& axis, Rng& rng) {
  const V2f u = rng.next2();
  return (axis + 0.3F * V3f(u.x - 0.5F, u.y - 0.5F, rng.next() - 0.5F)).normalized();
}

/// A tree that has learned in a few rounds that light comes from two sides.
DirectionTree taught(bool filter) {
  DirectionTree tree;
  Rng rng(21, 0, 0, Rng::Purpose::test);
  for (int round = 0; round < 4; ++round) {
    for (int i = 0; i < 3000; ++i) {
      tree.add(around(i % 4 == 0 ? V3f(-0.2F, -1, 0.01F) : V3f(1, 0.1F, 2), rng),
               double(rng.next()), filter);
    }
    tree.build();
    if (round < 3) tree = tree.refined(0.01, 20);
  }
  return tree;
}

TEST(DirectionTree, SquareAndBack) {
  Rng rng(22, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 1000; ++i) {
    const V2f p = rng.next2();
    const V3f w = from_square(p);
    EXPECT_NEAR(w.length(), 1, 1e-6);
    const V2f back = to_square(w);
    EXPECT_NEAR(back.x, p.x, 1e-6);
    EXPECT_NEAR(std::abs(std::remainder(back.y - p.y, 1.0F)), 0,
                1e-5 / std::sqrt(std::max(1e-4F, p.x * (1 - p.x))));
  }
  for (const V3f& w : {V3f(0, 0, 1), V3f(0, 0, -1), V3f(-1, -0.0F, 0), V3f(-1, 0, 0)}) {
    const V2f p = to_square(w);
    EXPECT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1) << p;
  }
}

TEST(DirectionTree, DrawsWithItsDensity) {
  const double level = statistics::sidak(1e-3, 2);
  for (const bool filter : {false, true}) {
    const DirectionTree tree = taught(filter);
    EXPECT_GT(tree.nodes(), 20U);
    Rng rng(23, 0, 0, Rng::Purpose::test);
    const auto c = test::density_check([&] { return std::optional(tree.sample(rng)); },
                                       [&](const V3f& w) { return tree.pdf(w).value; }, 40000, rng,
                                       V3f(0, 0, 1));
    EXPECT_GT(c.p, level);
    EXPECT_NEAR(c.integral, 1, 5 * c.integral_error + 1e-4);
  }
}

TEST(DirectionTree, KeepsAllEnergyButAtThePoles) {
  DirectionTree tree = taught(true).refined(0.01, 20);
  // Far from the poles of the map, also across the angle's ends.
  for (int i = 0; i < 100; ++i) {
    const double phi = 2 * std::numbers::pi * i / 100;
    tree.add(V3f(float(std::cos(phi)), float(std::sin(phi)), 0.01F).normalized(), 2, true);
  }
  tree.build();
  EXPECT_NEAR(tree.energy(), 200, 1e-3);
}

TEST(DirectionTree, WithoutEnergyNothingIsKnown) {
  DirectionTree tree;
  tree.build();
  EXPECT_TRUE(tree.empty());
  EXPECT_EQ(tree.pdf({0, 0, 1}).value, 0);
  EXPECT_EQ(tree.refined(0.01, 20).nodes(), 1U);
}

TEST(GuideState, OfAnotherSceneIsRefused) {
  for (const auto& [name, guide] : test::guides()) {
    SCOPED_TRACE(name);
    PathSettings path;
    path.guide = guide;
    const auto session = [&path](const char* scene) {
      return std::make_unique<test::Session>(
          load_gltf(test::own_scene(scene)),
          test::RenderSettings{.integrator = path, .width = 16, .height = 12});
    };
    const auto ajar = session("ajar.glb"), cornell = session("cornell.glb");
    ajar->iterate(0);
    ByteWriter saved;
    ajar->integrator().save(saved);
    if (saved.bytes().empty()) continue;  // it learns nothing
    // Trees over places hold for any scene.
    if (name != "sd_tree") {
      ByteReader in(saved.bytes());
      EXPECT_THROW(cornell->integrator().load(in), std::runtime_error);
    }
    ByteReader cut(std::string_view(saved.bytes()).substr(0, saved.bytes().size() - 1));
    EXPECT_THROW(ajar->integrator().load(cut), std::runtime_error);
  }
}

TEST(GuideState, ThatIsNoTreeIsRefused) {
  struct Node {
    std::array<float, 4> energy;
    std::array<std::uint32_t, 4> child;
  };
  const auto load = [](const std::vector<Node>& nodes) {
    ByteWriter out;
    out.put(nodes);
    ByteReader in(out.bytes());
    DirectionTree tree;
    tree.load(in);
  };
  EXPECT_NO_THROW(load({{{1, 2, 3, 4}, {1, 0, 0, 0}}, {{0, 0, 1, 0}, {}}}));
  EXPECT_THROW(load({}), std::runtime_error);
  EXPECT_THROW(load({{{1, 2, 3, 4}, {0, 7, 0, 0}}}), std::runtime_error);
  EXPECT_THROW(load({{{1, 2, 3, 4}, {1, 0, 0, 0}}, {{0, 0, 1, 0}, {1, 0, 0, 0}}}),
               std::runtime_error);
  EXPECT_THROW(load({{{1, -2, 3, 4}, {}}}), std::runtime_error);
  EXPECT_THROW(load({{{NAN, 2, 3, 4}, {}}}), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
