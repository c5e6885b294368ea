#include "renderer/scene/delta_surfaces.h"

#include <gtest/gtest.h>

#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::SceneParts;

/// A quad that fills the upper half of the picture, before nothing.
std::vector<std::string> delta_warnings(Material material) {
  SceneParts p;
  material.name = "pane";
  const auto mesh = p.quad({-5, 0, -1}, {10, 0, 0}, {0, 5, 0}, p.material(material));
  p.data.meshes[mesh].name = "window";
  p.eye({0, 0, 1}, {0, 0, 0}, 0.8);
  const Camera camera(p.data.cameras[0], 64, 64);
  return missing_reflections(test::lit_scene(std::move(p.data)), camera);
}

TEST(MissingReflections, AreWarnedOf) {
  for (const Material& m : {test::metal(Rgb(0.9F), 0), test::glass(0)}) {
    const auto said = delta_warnings(m);
    ASSERT_EQ(said.size(), 1U);
    for (const char* word : {"black", "\"pane\"", "\"window\"", "50 %"}) {
      EXPECT_NE(said[0].find(word), std::string::npos) << said[0];
    }
  }
  const auto coat = delta_warnings(test::plastic(Rgb(0.5F)));
  ASSERT_EQ(coat.size(), 1U);
  EXPECT_NE(coat[0].find("smooth coats"), std::string::npos) << coat[0];
  for (const Material& m :
       {test::diffuse(Rgb(0.5F)), test::metal(Rgb(0.9F), 0.3F), test::glass(0.3F)}) {
    EXPECT_TRUE(delta_warnings(m).empty());
  }
}

}  // namespace
}  // namespace lacuna
