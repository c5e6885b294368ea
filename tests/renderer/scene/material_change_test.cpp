// A material with another gloss: which materials change, and what is said where there is none.

#include "renderer/scene/material_change.h"

#include <gtest/gtest.h>

namespace lacuna {
namespace {

SceneData three_materials() {
  SceneData data;
  for (const char* name : {"floor", "wall", "floor"}) {
    Material m;
    m.name = name;
    m.metallic_roughness_texture.texture = 0;
    data.materials.push_back(m);
  }
  return data;
}

TEST(MaterialChange, ChangesAllOfTheNameAndNoOther) {
  SceneData data = three_materials();
  change_material(data, {.name = "floor", .roughness = 0.25, .metallic = 0.5}, "a.glb");
  for (const Material& m : data.materials) {
    const bool floor = m.name == "floor";
    EXPECT_EQ(m.roughness, floor ? 0.25F : 1);
    EXPECT_EQ(m.metallic, floor ? 0.5F : 1);
    EXPECT_EQ(m.metallic_roughness_texture.used(), !floor);
  }
}

TEST(MaterialChange, NamesWhatThereIs) {
  SceneData data = three_materials();
  try {
    change_material(data, {.name = "roof"}, "a.glb");
    FAIL() << "no error";
  } catch (const SceneError& e) {
    EXPECT_STREQ(e.what(), R"(scene "a.glb" has no material "roof"; it has "floor", "wall")");
  }
}

}  // namespace
}  // namespace lacuna
