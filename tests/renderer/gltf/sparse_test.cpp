#include <gtest/gtest.h>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::GlbBuilder;

/// The triangle's accessor 0 with some of its positions replaced.
template <class Index>
GlbBuilder with_replaced(const std::vector<Index>& indices, int component,
                         const std::vector<V3f>& values) {
  GlbBuilder b = test::triangle_scene();
  const auto index_view = b.add_view(indices);
  const auto value_view = b.add_view(values);
  b.json["accessors"][0]["sparse"] = {
      {"count", indices.size()},
      {"indices", {{"bufferView", index_view}, {"componentType", component}}},
      {"values", {{"bufferView", value_view}}}};
  return b;
}

TEST(Sparse, ReplacesSomeElements) {
  const std::vector<V3f> values{{-1, -2, -3}, {0, 5, 7}};
  const auto positions = [&](const GlbBuilder& b) { return load(b).meshes.at(0).positions; };
  const std::vector<V3f> wanted{{-1, -2, -3}, {1, 0, 0}, {0, 5, 7}};
  EXPECT_EQ(positions(with_replaced(std::vector<std::uint8_t>{0, 2}, 5121, values)), wanted);
  EXPECT_EQ(positions(with_replaced(std::vector<std::uint16_t>{0, 2}, 5123, values)), wanted);
  EXPECT_EQ(positions(with_replaced(std::vector<std::uint32_t>{0, 2}, 5125, values)), wanted);
}

TEST(Sparse, WithoutABufferViewTheOthersAreZero) {
  GlbBuilder b = with_replaced(std::vector<std::uint8_t>{1, 2}, 5121, {{3, 0, 0}, {0, 4, 0}});
  b.json["accessors"][0].erase("bufferView");
  EXPECT_EQ(load(b).meshes.at(0).positions, (std::vector<V3f>{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}}));
}

TEST(Sparse, OffsetsStartBothParts) {
  GlbBuilder b =
      with_replaced(std::vector<std::uint16_t>{9, 1}, 5123, {{9, 9, 9}, {6, 0, 0}, {9, 9, 9}});
  Json& sparse = b.json["accessors"][0]["sparse"];
  sparse["count"] = 1;
  sparse["indices"]["byteOffset"] = 2;
  sparse["values"]["byteOffset"] = 12;
  EXPECT_EQ(load(b).meshes.at(0).positions, (std::vector<V3f>{{0, 0, 0}, {6, 0, 0}, {0, 1, 0}}));
}

TEST(Sparse, ReplacesIndicesToo) {
  GlbBuilder b;
  const auto mesh = b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}});
  b.add_node({{"mesh", mesh}});
  const auto indices = b.add_view(std::vector<std::uint8_t>{2});
  const auto values = b.add_view(std::vector<std::uint32_t>{3});
  b.json["accessors"][1]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  EXPECT_EQ(load(b).meshes.at(0).positions.back(), V3f(0, 0, 1));
}

/// What the error of a scene says, once one value of its `sparse` is replaced.
std::string error_with(const std::string& pointer, const Json& value,
                       const std::vector<std::uint8_t>& indices = {0, 2}) {
  GlbBuilder b = with_replaced(indices, 5121, {{-1, -2, -3}, {0, 5, 7}});
  if (!pointer.empty()) b.json["accessors"][0]["sparse"][Json::json_pointer(pointer)] = value;
  try {
    load(b);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "loaded";
}

TEST(Sparse, HostileOnesAreRefusedWithTheirPlace) {
  const std::string place = "accessors[0], used as POSITION of meshes[0].primitives[0]";
  const auto expect = [](const std::string& error, const std::string& words) {
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  EXPECT_EQ(error_with("", {}), "loaded");
  expect(error_with("", {}, {0, 3}), place);
  expect(error_with("", {}, {0, 3}), "sparse.indices[1] is 3; allowed: below its count, 3");
  expect(error_with("", {}, {2, 2}), "sparse.indices[1] is 2; allowed: above the one before, 2");
  expect(error_with("", {}, {2, 0}), "sparse.indices[1] is 0; allowed: above the one before, 2");
  const std::string sparse = "accessors[0].sparse";
  expect(error_with("/count", 4), sparse + ": count: found number 4; allowed: an integer from 1");
  expect(error_with("/count", 0), sparse + ": count: found number 0");
  expect(error_with("/count", 3), sparse + ".indices: 3 elements end at byte 3 of bufferViews[2]");
  expect(error_with("/values/bufferView", 7), sparse + ".values: bufferView: found number 7");
  expect(error_with("/values/bufferView", 1), sparse + ".values: 2 elements end at byte 24");
  expect(error_with("/values/byteOffset", 4294967295), sparse + ".values: 2 elements end at byte");
  expect(error_with("/indices/byteOffset", -1), sparse + ".indices: byteOffset: found number -1");
  expect(error_with("/indices/componentType", 5126), sparse + ".indices: componentType: found");
  expect(error_with("/indices/componentType", 5122), sparse + ".indices: componentType: found");
  expect(error_with("/indices", {{"componentType", 5121}}), "bufferView is missing");
}

}  // namespace
}  // namespace lacuna
