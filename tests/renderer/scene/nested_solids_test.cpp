#include "renderer/scene/nested_solids.h"

#include <gtest/gtest.h>

#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

/// A box of `outer` around one of `inner`, which is at `x`, and an opaque one in both.
std::vector<std::string> warnings(const Material& outer, const Material& inner, float x) {
  test::SceneParts p;
  p.box({-2, -2, -2}, {2, 2, 2}, true, p.material(outer));
  p.box({x - 1, -1, -1}, {x + 1, 1, 1}, true, p.material(inner));
  p.box({x - 0.5F, -0.5F, -0.5F}, {x + 0.5F, 0.5F, 0.5F}, true,
        p.material(test::diffuse(Rgb(0.5F))));
  return nested_solids(test::lit_scene(std::move(p.data)));
}

TEST(NestedSolids, AreWarnedOf) {
  const auto said = warnings(test::glass(), test::glass(), 0);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(said[0].starts_with("6 transmitting meshes lie in other solids")) << said[0];
}

TEST(NestedSolids, OthersAreNot) {
  EXPECT_TRUE(warnings(test::glass(), test::glass(), 5).empty()) << "side by side";
  EXPECT_TRUE(warnings(test::glass(), test::window(), 0).empty());
  EXPECT_TRUE(warnings(test::glass(), test::metal(Rgb(0.9F), 0.2F), 0).empty());
}

}  // namespace
}  // namespace lacuna
