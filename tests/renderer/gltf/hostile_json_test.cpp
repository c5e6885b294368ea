#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::GlbBuilder;

/// One thing wrong with an otherwise good scene: a triangle with a material, a camera and a light.
struct HostileCase {
  std::string name;
  std::function<void(GlbBuilder&)> spoil;
  std::vector<std::string> message;  ///< each must occur in the error
};

std::ostream& operator<<(std::ostream& out, const HostileCase& c) { return out << c.name; }

GlbBuilder good_scene() {
  GlbBuilder builder = test::triangle_scene();
  builder.add_material({{"name", "paint"}, {"pbrMetallicRoughness", Json::object()}});
  builder.json["meshes"][0]["primitives"][0]["material"] = 0;
  builder.add_camera("eye", {0, 0, 5}, 0.8);
  builder.add_light({{"type", "spot"}, {"name", "lamp"}, {"spot", Json::object()}});
  return builder;
}

/// A case that sets the value at a JSON pointer.
HostileCase set(std::string name, const std::string& pointer, const Json& value,
                std::vector<std::string> message) {
  return {std::move(name),
          [pointer, value](GlbBuilder& b) { b.json[Json::json_pointer(pointer)] = value; },
          std::move(message)};
}

/// A case where an accessor has no data but those of an extension of the primitive.
HostileCase compressed(std::string name, std::size_t accessor, const std::string& extension) {
  return {std::move(name),
          [=](GlbBuilder& b) {
            b.json["accessors"][accessor].erase("bufferView");
            b.json["meshes"][0]["primitives"][0]["extensions"][extension] = {{"bufferView", 0}};
          },
          {"meshes[0].primitives[0]: its data come by extension " + extension +
           ", which is not supported, and there is no fallback"}};
}

const char* const light = "/extensions/KHR_lights_punctual/lights/0";
const char* const primitive = "/meshes/0/primitives/0";

std::vector<HostileCase> structure_cases() {
  const std::string p = primitive;
  return {
      set("NoVersion", "/asset", Json::object(), {"asset: version: missing"}),
      set("VersionOne", "/asset/version", "1.0", {"asset: version: found string \"1.0\""}),
      set("RequiredExtension", "/extensionsRequired", {"KHR_texture_basisu"},
          {"extensionsRequired: found \"KHR_texture_basisu\"", "KHR_materials_ior"}),
      set("BuffersNotAnArray", "/accessors", 7, {"accessors: found number 7; allowed: a list"}),
      set("AccessorNotAnObject", "/accessors/0", 7,
          {"accessors[0]: found number 7; allowed: an object"}),
      set("NegativeOffset", "/bufferViews/0/byteOffset", -4,
          {"bufferViews[0]: byteOffset: found number -4; allowed: an integer from 0"}),
      set("FractionalOffset", "/bufferViews/0/byteOffset", 0.5,
          {"bufferViews[0]: byteOffset: found number 0.5"}),
      set("OffsetAsString", "/accessors/0/byteOffset", "0",
          {"accessors[0]: byteOffset: found string \"0\""}),
      set("ViewOutsideBuffer", "/bufferViews/1/byteLength", 1000, {"bufferViews[1]", "buffers[0]"}),
      set("ViewOffsetWraps", "/bufferViews/0/byteOffset", 4294967295,
          {"bufferViews[0]", "buffers[0]"}),
      set("ViewWithoutBuffer", "/bufferViews/0/buffer", 3,
          {"bufferViews[0]: buffer: found number 3; allowed: an index below 1 (buffers)"}),
      set("BadStride", "/bufferViews/0/byteStride", 6,
          {"bufferViews[0]: byteStride: found number 6"}),
      set("StrideBelowElement", "/bufferViews/0/byteStride", 8, {"accessors[0]", "byteStride 8"}),
      set("AccessorOutsideView", "/accessors/0/count", 4,
          {"accessors[0]: 4 elements end at byte 48 of bufferViews[0], which has 36"}),
      set("AccessorOneByteOutside", "/accessors/0/byteOffset", 1,
          {"accessors[0]: 3 elements end at byte 37 of bufferViews[0], which has 36"}),
      set("ViewOneByteOutside", "/bufferViews/1/byteLength", 13,
          {"bufferViews[1]: bytes 36 to 49 are outside of buffers[0], which has 48"}),
      set("CountTwoToThe32", "/accessors/0/count", 4294967296,
          {"accessors[0]: count: found number 4294967296"}),
      set("CountNearlyTwoToThe32", "/accessors/0/count", 4294967295, {"accessors[0]"}),
      set("CountMinusOne", "/accessors/0/count", -1, {"accessors[0]: count: found number -1"}),
      set("CountZero", "/accessors/0/count", 0, {"accessors[0]: count: found number 0"}),
      set("ComponentDouble", "/accessors/0/componentType", 5130,
          {"accessors[0]: componentType: found number 5130"}),
      set("ComponentInt", "/accessors/0/componentType", 5124,
          {"accessors[0]: componentType: found number 5124"}),
      set("TypeUnknown", "/accessors/0/type", "VEC9",
          {"accessors[0]: type: found string \"VEC9\""}),
      set("NothingButZeros", "/accessors/0",
          {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
          {"the scene has no triangles (dropped: 1 of zero area"}),
      set("ZerosWithoutEnd", "/accessors/0",
          {{"componentType", 5126}, {"count", 4000000000}, {"type", "VEC3"}},
          {"accessors[0]: count: found number 4000000000; allowed: at most 16777216 without"}),
      set("PositionsAsIntegers", "/accessors/0/componentType", 5125,
          {"accessors[0], used as POSITION of meshes[0].primitives[0]"}),
      set("IndicesAsFloats", "/accessors/1/componentType", 5126, {"accessors[1], used as indices"}),
      set("NoPrimitives", "/meshes/0/primitives", Json::array(), {"meshes[0]: primitives"}),
      set("AttributeOutOfRange", p + "/attributes/POSITION", 99,
          {"meshes[0].primitives[0].attributes: POSITION: found number 99; allowed: an index below "
           "2"}),
      set("ModeSeven", p + "/mode", 7, {"meshes[0].primitives[0]: mode: found number 7"}),
      set("MaterialOutOfRange", p + "/material", 5,
          {"meshes[0].primitives[0]: material: found number 5"}),
      set("NormalsOfAnotherCount", p + "/attributes/NORMAL", 1, {"accessors[1], used as NORMAL"}),
      set("MeshOutOfRange", "/nodes/0/mesh", 1, {"nodes[0] \"thing\": mesh: found number 1"}),
      set("NegativeMesh", "/nodes/0/mesh", -1, {"nodes[0] \"thing\": mesh: found number -1"}),
      set("SceneOutOfRange", "/scene", 1,
          {"scene: found number 1; allowed: an index below 1 (scenes)"}),
      set("SceneNodeTwice", "/scenes/0/nodes", {0, 0},
          {"scenes[0]: lists nodes[0] \"thing\" twice"}),
      set("OwnChild", "/nodes/0/children", {0}, {"nodes[0] \"thing\"", "its own ancestor"}),
      set("ChildOutOfRange", "/nodes/0/children", {17},
          {"nodes[0] \"thing\": children[0]: found number 17"}),
      set("BadRotation", "/nodes/0/rotation", {0, 0, 0, 0},
          {"nodes[0] \"thing\": rotation has length"}),
      set("ShortMatrix", "/nodes/0/matrix", {1, 2, 3},
          {"nodes[0] \"thing\": matrix", "a list of exactly 16"}),
      set("ProjectiveMatrix", "/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
          {"nodes[0] \"thing\"", "fourth row"}),
      set("MatrixWTooFarOff", "/nodes/0/matrix",
          {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.01},
          {"nodes[0] \"thing\"", "fourth row of matrix is 0 0 0 1.01; allowed: 0 0 0 1"}),
      set("RotationTooFarOff", "/nodes/0/rotation", {0, 0, 0, 1.02},
          {"nodes[0] \"thing\": rotation has length 1.02"}),
      set("OverflowingScale", "/nodes/0/scale", {1e300, 1e300, 1e300},
          {"nodes[0] \"thing\": its transform, with those of its parents, is too large"}),
      set("FarAway", "/nodes/0/translation", {0, 1e16, 0},
          {"nodes[0] \"thing\"", "vertex 0", "1e15"}),
      set("PointsOnly", p + "/mode", 0,
          {"the scene has no triangles", "left out: 1 primitives of points or lines)"}),
      set("NothingButHidden", "/nodes/0/scale", {0, 0, 0},
          {"the scene has no triangles", "left out: 1 meshes under a scale of 0)"}),
      compressed("IndicesOfAnUnknownKind", 1, "ACME_mesh_compression"),
      compressed("PositionsOfAnUnknownKind", 0, "ACME_mesh_compression"),
      set("IndicesWithoutData", "/accessors/1",
          {{"componentType", 5125}, {"count", 3}, {"type", "SCALAR"}},
          {"accessors[1]: used as indices of triangles: it has no bufferView"}),
      {"BufferWithoutFallback",
       [](GlbBuilder& b) {
         b.json["buffers"] = {
             {{"byteLength", b.bin.size()}},
             {{"byteLength", 48}, {"extensions", {{"ACME_compression", {{"fallback", true}}}}}}};
         b.json["bufferViews"][0]["buffer"] = 1;
       },
       {"buffers[1]: its data come by extension ACME_compression, which is not supported"}},
      set("NoNodes", "/scenes/0/nodes", Json::array(), {"the scene has no triangles"}),
  };
}

std::vector<HostileCase> value_cases() {
  const std::string l = light;
  return {
      set("YfovZero", "/cameras/0/perspective/yfov", 0,
          {"cameras[0].perspective: yfov: found number 0"}),
      set("YfovPi", "/cameras/0/perspective/yfov", 3.15,
          {"cameras[0].perspective: yfov: found number 3.15"}),
      set("CameraType", "/cameras/0/type", "fisheye",
          {"cameras[0] \"eye\": type: found string \"fisheye\""}),
      set("LightType", l + "/type", "area", {"lights[0] \"lamp\": type: found string \"area\""}),
      set("LightIntensity", l + "/intensity", -1,
          {"lights[0] \"lamp\": intensity: found number -1"}),
      set("LightIntensityHuge", l + "/intensity", 1e39,
          {"lights[0] \"lamp\": intensity: found number 1e+39"}),
      set("LightColor", l + "/color", {1, 1}, {"lights[0] \"lamp\": color", "a list of exactly 3"}),
      set("LightColorFarBelow", l + "/color", {1, -0.1, 1},
          {"lights[0] \"lamp\": color[1]: found number -0.1; allowed: a number from 0"}),
      set("LightColorTimesIntensity", l,
          {{"type", "point"}, {"name", "lamp"}, {"color", {2, 2, 2}}, {"intensity", 3e38}},
          {"lights[0] \"lamp\": color times intensity is more"}),
      set("ConesReversed", l + "/spot/innerConeAngle", 1,
          {"lights[0].spot", "innerConeAngle 1 is above outerConeAngle 0.785"}),
      set("ConeEmpty", l + "/spot/outerConeAngle", 0,
          {"lights[0].spot: outerConeAngle: found number 0", "above 0"}),
      set("ConeTooWide", l + "/spot/outerConeAngle", 1.6,
          {"lights[0].spot: outerConeAngle: found number 1.6"}),
      set("LightIndex", "/nodes/2/extensions/KHR_lights_punctual/light", 1,
          {"nodes[2].extensions.KHR_lights_punctual: light: found number 1"}),
      set("ExtensionsNotAnObject", "/nodes/2/extensions", 5,
          {"nodes[2]: extensions: found number 5"}),
      set("BaseColor", "/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 1, 1.5, 1},
          {"materials[0].pbrMetallicRoughness: baseColorFactor[2]: found number 1.5"}),
      set("BaseColorNull", "/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 1, nullptr, 1},
          {"baseColorFactor[2]: found null"}),
      set("Roughness", "/materials/0/pbrMetallicRoughness/roughnessFactor", -0.1,
          {"materials[0].pbrMetallicRoughness: roughnessFactor: found number -0.1", "from 0 to 1"}),
      set("EmissiveFactor", "/materials/0/emissiveFactor", "white",
          {"materials[0] \"paint\": emissiveFactor: found string \"white\""}),
      set("EmissiveStrengthString",
          "/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", "5",
          {"materials[0].extensions.KHR_materials_emissive_strength: emissiveStrength: found "
           "string \"5\""}),
      set("Ior", "/materials/0/extensions/KHR_materials_ior/ior", 0.5,
          {"materials[0].extensions.KHR_materials_ior: ior: found number 0.5; allowed: 0"}),
      set("Specular", "/materials/0/extensions/KHR_materials_specular/specularFactor", 2,
          {"KHR_materials_specular: specularFactor: found number 2"}),
      set("Transmission", "/materials/0/extensions/KHR_materials_transmission/transmissionFactor",
          true, {"KHR_materials_transmission: transmissionFactor: found true"}),
      set("AlphaMode", "/materials/0/alphaMode", "HASH",
          {"materials[0] \"paint\": alphaMode: found string \"HASH\""}),
      set("DoubleSided", "/materials/0/doubleSided", 1,
          {"materials[0] \"paint\": doubleSided: found number 1"}),
      set("TextureOutOfRange", "/materials/0/emissiveTexture/index", 0,
          {"materials[0].emissiveTexture: index: found number 0; allowed: an index below 0 "
           "(textures)"}),
  };
}

std::vector<HostileCase> graph_cases() {
  return {
      {"Cycle",
       [](GlbBuilder& b) {
         b.json["nodes"][0]["children"] = {3};
         b.json["nodes"].push_back({{"name", "inner"}, {"children", {0}}});
       },
       {"its own ancestor"}},
      {"CycleOutsideOfTheScene",
       [](GlbBuilder& b) {
         b.json["nodes"].push_back({{"name", "x"}, {"children", {4}}});
         b.json["nodes"].push_back({{"name", "y"}, {"children", {3}}});
       },
       {"nodes[3] \"x\"", "its own ancestor"}},
      {"TwoParents",
       [](GlbBuilder& b) {
         b.json["nodes"].push_back({{"name", "child"}});
         b.json["nodes"][0]["children"] = {3};
         b.json["nodes"][1]["children"] = {3};
       },
       {"nodes[3] \"child\": has two parents", "nodes[0] \"thing\"", "nodes[1]"}},
      {"InfiniteTransform",
       [](GlbBuilder& b) {
         b.json["nodes"].push_back({{"scale", {1e200, 1, 1}}, {"children", {4}}});
         b.json["nodes"].push_back({{"scale", {1e200, 1, 1}}, {"children", {0}}});
         b.json["scenes"][0]["nodes"] = {3};
       },
       {"nodes[0] \"thing\": its transform, with those of its parents, is too large or not "
        "finite"}},
      {"SceneListsAChild",
       [](GlbBuilder& b) { b.json["nodes"][0]["children"] = {1}; },
       {"scenes[0]: lists nodes[1], which is a child of nodes[0] \"thing\""}},
      {"TooDeep",
       [](GlbBuilder& b) {
         for (int i = 0; i < 300; ++i) {
           b.json["nodes"].push_back({{"children", {i + 4}}});
         }
         b.json["nodes"].push_back({{"name", "bottom"}});
         b.json["scenes"][0]["nodes"].push_back(3);
       },
       {"more than 256 levels deep"}},
      {"TooManyTriangles",
       [](GlbBuilder& b) {
         // 4,000 nodes share one fan of 40,000 triangles: small on disk, 160 million in memory, as
         // each lamp has a copy.
         const std::vector<V3f> points(40002, V3f(1, 2, 3));
         b.json["materials"].push_back({{"emissiveFactor", {1, 1, 1}}});
         b.json["meshes"][0]["primitives"][0] = {
             {"mode", 6},
             {"material", b.json["materials"].size() - 1},
             {"attributes", {{"POSITION", b.add_accessor(points, 5126, "VEC3")}}}};
         for (int i = 0; i < 4000; ++i) b.add_node({{"mesh", 0}});
       },
       {"triangles in all"}},
  };
}

class HostileJson : public testing::TestWithParam<HostileCase> {};

TEST_P(HostileJson, IsRefusedWithItsPlace) {
  const TemporaryFolder folder;
  GlbBuilder builder = good_scene();
  GetParam().spoil(builder);
  const auto file = folder.write("scene.glb", builder.glb());
  try {
    load_gltf(file);
    FAIL() << "was accepted";
  } catch (const SceneError& e) {
    for (const auto& part : GetParam().message) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  }
}

const auto case_name = [](const auto& c) { return c.param.name; };
INSTANTIATE_TEST_SUITE_P(Structure, HostileJson, testing::ValuesIn(structure_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Values, HostileJson, testing::ValuesIn(value_cases()), case_name);
INSTANTIATE_TEST_SUITE_P(Graph, HostileJson, testing::ValuesIn(graph_cases()), case_name);

TEST(HostileJsonBase, TheUnspoiltSceneLoads) {
  const TemporaryFolder folder;
  const SceneData scene = load_gltf(folder.write("scene.glb", good_scene().glb()));
  EXPECT_EQ(scene.triangle_count(), 1U);
  EXPECT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.lights.size(), 1U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(HostileJsonBase, ASingularNodeThatCarriesNothingIsFine) {
  const TemporaryFolder folder;
  GlbBuilder builder = good_scene();
  builder.add_node({{"name", "empty"}, {"scale", {0, 0, 0}}});
  EXPECT_EQ(load_gltf(folder.write("scene.glb", builder.glb())).triangle_count(), 1U);
}

}  // namespace
}  // namespace lacuna
