#include <draco/compression/encode.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::GlbBuilder;
using Colour = std::array<std::uint8_t, 4>;

/// A wavy sheet over the unit square, and a colour for each of its vertices.
struct Sheet {
  static constexpr int side = 9;  // vertices
  std::vector<V3f> positions, normals;
  std::vector<Colour> colours;
  test::Triangles triangles;

  Sheet() {
    for (int i = 0; i < side * side; ++i) {
      const float x = float(i % side) / (side - 1), y = float(i / side) / (side - 1);
      positions.emplace_back(x, y, 0.1F * std::sin(9 * x) * y);
      normals.push_back(V3f(-0.9F * std::cos(9 * x) * y, -0.1F * std::sin(9 * x), 1).normalized());
      colours.push_back({std::uint8_t(3 * i), std::uint8_t(255 - i), 0, 255});
    }
    for (std::uint32_t y = 0; y + 1 < side; ++y) {
      for (std::uint32_t x = 0; x + 1 < side; ++x) {
        const std::uint32_t a = y * side + x;
        triangles.push_back({a, a + 1, a + side + 1});
        triangles.push_back({a, a + side + 1, a + side});
      }
    }
  }
};

template <class T>
std::uint32_t add_to(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType data,
                     bool normalized, const std::vector<T>& values) {
  const auto components = static_cast<std::int8_t>(sizeof(T) / std::size_t(DataTypeLength(data)));
  draco::GeometryAttribute a;
  a.Init(type, nullptr, std::uint8_t(components), data, normalized, sizeof(T), 0);
  const auto n = static_cast<std::uint32_t>(values.size());
  const int id = mesh.AddAttribute(a, true, n);
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i]);
  }
  return mesh.attribute(id)->unique_id();
}

/// `speed` 0 is the edgebreaker, 10 the sequential encoder.
test::Bytes encoded(const Sheet& sheet, int speed) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(sheet.positions.size()));
  using Type = draco::GeometryAttribute;
  EXPECT_EQ(add_to(mesh, Type::POSITION, draco::DT_FLOAT32, false, sheet.positions), 0U);
  EXPECT_EQ(add_to(mesh, Type::NORMAL, draco::DT_FLOAT32, false, sheet.normals), 1U);
  EXPECT_EQ(add_to(mesh, Type::COLOR, draco::DT_UINT8, true, sheet.colours), 2U);
  for (const auto& t : sheet.triangles) {
    mesh.AddFace({draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  }
  draco::Encoder encoder;
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetAttributeQuantization(Type::POSITION, 16);
  encoder.SetAttributeQuantization(Type::NORMAL, 12);
  draco::EncoderBuffer out;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &out).ok());
  return {out.data(), out.data() + out.size()};
}

/// A file of a compressed sheet alone.
GlbBuilder file_of(const test::Bytes& data) {
  const Sheet sheet;
  GlbBuilder b;
  const std::size_t view = b.add_view(data);
  const auto accessor = [&b](std::size_t count, int component, const std::string& type) {
    b.json["accessors"].push_back({{"componentType", component}, {"count", count}, {"type", type}});
  };
  const std::size_t vertices = sheet.positions.size();
  accessor(3 * sheet.triangles.size(), test::component_u16, "SCALAR");
  accessor(vertices, test::component_float, "VEC3");
  accessor(vertices, test::component_float, "VEC3");
  accessor(vertices, test::component_u8, "VEC4");
  b.json["accessors"][3]["normalized"] = true;
  Json primitive{{"indices", 0}, {"attributes", {{"POSITION", 1}, {"NORMAL", 2}, {"COLOR_0", 3}}}};
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"COLOR_0", 2}}}};
  b.json["meshes"] = {{{"primitives", {primitive}}}};
  b.json["extensionsRequired"] = b.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  b.add_node({{"mesh", 0}});
  return b;
}

std::string draco_refusal(const GlbBuilder& b) {
  try {
    load(b);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "";
}

/// Of a compressed sheet, changed by `change`.
std::string refusal_of(const std::function<void(GlbBuilder&)>& change, int speed = 0) {
  GlbBuilder b = file_of(encoded(Sheet(), speed));
  change(b);
  return draco_refusal(b);
}

Json& draco_of(GlbBuilder& b) {
  return b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
}

class DracoMethods : public testing::TestWithParam<int> {};

TEST_P(DracoMethods, VerticesAndTrianglesComeBackWithinTheirQuantization) {
  const Sheet sheet;
  const SceneData scene = load(file_of(encoded(sheet, GetParam())));
  EXPECT_TRUE(scene.warnings.empty());
  ASSERT_EQ(scene.meshes.size(), 1U);
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.positions.size(), sheet.positions.size());
  std::vector<std::uint32_t> original(mesh.positions.size());
  for (std::size_t i = 0; i < original.size(); ++i) {
    const auto near = std::ranges::min_element(
        sheet.positions, {}, [&](const V3f& p) { return (p - mesh.positions[i]).length(); });
    original[i] = static_cast<std::uint32_t>(near - sheet.positions.begin());
    EXPECT_LT((*near - mesh.positions[i]).length(), 1e-4F);
    EXPECT_LT((sheet.normals[original[i]] - mesh.normals[i]).length(), 2e-3F);
    EXPECT_FLOAT_EQ(mesh.colors[i].x, float(sheet.colours[original[i]][0]) / 255);
  }
  const auto rotated = [](std::array<std::uint32_t, 3> t) {
    std::ranges::rotate(t, std::ranges::min_element(t));
    return t;
  };
  test::Triangles found, wanted;
  for (const auto& t : mesh.triangles) {
    found.push_back(rotated({original[t[0]], original[t[1]], original[t[2]]}));
  }
  for (const auto& t : sheet.triangles) wanted.push_back(rotated(t));
  std::ranges::sort(found);
  std::ranges::sort(wanted);
  EXPECT_EQ(found, wanted);
}

TEST_P(DracoMethods, DamagedDataAreRefusedOrStayInTheirBounds) {
  const test::Bytes whole = encoded(Sheet(), GetParam());
  for (std::size_t cut = 1; cut < whole.size(); cut += 5) {
    EXPECT_NE(draco_refusal(file_of({whole.begin(), whole.begin() + long(cut)})), "") << cut;
  }
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    test::Bytes other = whole;
    other[at] ^= 0x55;
    draco_refusal(file_of(other));  // it may load: then its indices were in range
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, DracoMethods, testing::Values(0, 5, 10));

TEST(Draco, WhatTheDataClaimMustAgreeWithTheAccessors) {
  for (const int speed : {0, 10}) {
    const auto fewer = [](GlbBuilder& b) { b.json["accessors"][0]["count"] = 3; };
    EXPECT_NE(refusal_of(fewer, speed).find("other numbers of triangles"), std::string::npos);
    const auto too_few = [](GlbBuilder& b) {
      for (int i = 1; i < 4; ++i) b.json["accessors"][i]["count"] = 80;
    };
    EXPECT_NE(refusal_of(too_few, speed).find("vertices"), std::string::npos);
  }
  const auto many = [](GlbBuilder& b) { b.json["accessors"][0]["count"] = 300'000'000; };
  EXPECT_NE(refusal_of(many).find("allowed: 256 a byte"), std::string::npos);
  const auto short_ints = [](GlbBuilder& b) { b.json["accessors"][3]["componentType"] = 5123; };
  EXPECT_NE(refusal_of(short_ints).find("COLOR_0 is of another type"), std::string::npos);
  const auto unknown = [](GlbBuilder& b) { draco_of(b)["attributes"]["NORMAL"] = 7; };
  EXPECT_NE(refusal_of(unknown).find("no attribute 7 for NORMAL"), std::string::npos);
  const auto strip = [](GlbBuilder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 5; };
  EXPECT_NE(refusal_of(strip).find("4 (triangles)"), std::string::npos);
  const auto missing = [](GlbBuilder& b) { draco_of(b)["attributes"].erase("POSITION"); };
  EXPECT_NE(refusal_of(missing), "");
  const auto none = [](GlbBuilder& b) { draco_of(b).erase("bufferView"); };
  EXPECT_NE(refusal_of(none).find("bufferView or attributes is missing"), std::string::npos);
}

TEST(Draco, OnlyVersion2Point2WithoutMetadataIsRead) {
  const test::Bytes whole = encoded(Sheet(), 0);
  const auto with = [&](std::size_t at, std::uint8_t value) {
    test::Bytes other = whole;
    other[at] = value;
    return draco_refusal(file_of(other));
  };
  EXPECT_NE(with(0, 'd').find("header of Draco"), std::string::npos);
  EXPECT_NE(with(6, 1).find("version 2.1"), std::string::npos);
  EXPECT_NE(with(7, 0).find("no mesh of Draco"), std::string::npos);
  EXPECT_NE(with(10, 0x80).find("metadata"), std::string::npos);
}

}  // namespace
}  // namespace lacuna
