#include <gtest/gtest.h>

#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::GlbBuilder;

/// A triangle, and below a node another one, a light and a camera.
SceneData with_visibility(const Json& upper, const Json& lower) {
  GlbBuilder b = test::triangle_scene();
  b.json["extensionsUsed"] = {"KHR_node_visibility", "KHR_lights_punctual"};
  b.json["extensionsRequired"] = {"KHR_node_visibility"};
  b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 1}}}}};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  const auto parent = b.add_node({{"extensions", {{"KHR_node_visibility", upper}}}});
  const Json light{{"KHR_lights_punctual", {{"light", 0}}}, {"KHR_node_visibility", lower}};
  b.json["nodes"][parent]["children"] = {parent + 1};
  b.json["nodes"].push_back({{"mesh", 0}, {"camera", 0}, {"extensions", light}});
  return load(b);
}

TEST(NodeVisibility, HidesMeshesAndLightsBelow) {
  const Json shown{{"visible", true}}, hidden{{"visible", false}}, unsaid = Json::object();
  for (const auto& [upper, lower, triangles] : {std::tuple(unsaid, shown, 2U),
                                                {shown, unsaid, 2U},
                                                {hidden, shown, 1U},
                                                {shown, hidden, 1U}}) {
    const SceneData scene = with_visibility(upper, lower);
    EXPECT_EQ(scene.triangle_count(), triangles) << upper << lower;
    EXPECT_EQ(scene.lights.size(), triangles - 1);
    EXPECT_EQ(scene.cameras.size(), 1U);
    EXPECT_TRUE(scene.warnings.empty());
  }
}

}  // namespace
}  // namespace lacuna
