#include "jobs/import/ply_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "renderer/core/scene_error.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

ImportedMesh ply_of(const std::string& text, std::vector<std::string>* skipped = nullptr) {
  return ply_mesh({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "mesh.ply",
                  skipped);
}

std::string refusal_of_ply(const std::string& text) {
  return message_of<SceneError>([&] { ply_of(text); });
}

const std::string ascii_quad =
    "ply\nformat ascii 1.0\ncomment a quad\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty float u\nproperty float v\nproperty uchar red\nproperty uchar "
    "green\nproperty uchar blue\nproperty float quality\nelement face 1\nproperty list uchar int "
    "vertex_indices\nelement edge 1\nproperty int a\nend_header\n"
    "0 0 0 0 0 255 0 0 9\n1 0 0 1 0 0 255 0 9\n1 1 0 1 1 0 0 255 9\n0 1 0 0 1 51 51 51 9\n"
    "4 0 1 2 3\n7\n";

TEST(PlyMesh, ReadsTextWithColoursAndPolygons) {
  std::vector<std::string> skipped;
  const ImportedMesh mesh = ply_of(ascii_quad, &skipped);
  ASSERT_EQ(mesh.positions.size(), 4U);
  EXPECT_EQ(mesh.positions[2], V3f(1, 1, 0));
  EXPECT_TRUE(mesh.normals.empty());
  ASSERT_EQ(mesh.uvs.size(), 4U);
  EXPECT_EQ(mesh.uvs[3], V2f(0, 1));
  ASSERT_EQ(mesh.colors.size(), 4U);
  EXPECT_FLOAT_EQ(mesh.colors[3].x, .2F);
  const std::vector<std::array<std::uint32_t, 3>> fan{{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(mesh.triangles, fan);
  EXPECT_EQ(skipped, (std::vector<std::string>{"vertex property quality", "element edge"}));
}

template <class T>
void append(std::string& to, T value, bool big_endian) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  to += bytes;
}

std::string binary_triangle(bool big_endian) {
  std::string file = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                     "_endian 1.0\nelement vertex 3\nproperty double x\nproperty float y\nproperty "
                     "short z\nproperty float nx\nproperty float ny\nproperty float nz\nelement "
                     "face 1\nproperty uchar flags\nproperty list uchar uint vertex_index\n"
                     "end_header\n";
  for (int i = 0; i < 3; ++i) {
    append(file, double(i) / 2, big_endian);
    append(file, float(i * i), big_endian);
    append(file, std::int16_t(-i), big_endian);
    for (const float n : {0.F, 0.F, 1.F}) append(file, n, big_endian);
  }
  append(file, std::uint8_t{77}, big_endian);
  append(file, std::uint8_t{3}, big_endian);
  for (const std::uint32_t i : {2U, 1U, 0U}) append(file, i, big_endian);
  return file;
}

TEST(PlyMesh, ReadsBinaryOfEitherByteOrder) {
  for (const bool big_endian : {false, true}) {
    const ImportedMesh mesh = ply_of(binary_triangle(big_endian));
    ASSERT_EQ(mesh.positions.size(), 3U);
    EXPECT_EQ(mesh.positions[2], V3f(1, 4, -2));
    ASSERT_EQ(mesh.normals.size(), 3U);
    EXPECT_EQ(mesh.normals[1], V3f(0, 0, 1));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{2, 1, 0}}));
  }
}

TEST(PlyMesh, RefusesWhatIsShorterThanItsHeaderSays) {
  const std::string whole = binary_triangle(false);
  for (std::size_t n = 0; n < whole.size(); ++n) {
    EXPECT_THROW(ply_of(whole.substr(0, n)), SceneError) << n;
  }
  std::string huge = whole;
  huge.replace(huge.find("vertex 3"), 8, "vertex 4000000000");
  EXPECT_TRUE(contains(refusal_of_ply(huge), "promises 4000000000 items of element \"vertex\""));
}

TEST(PlyMesh, NamesWhatIsWrong) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = ascii_quad;
    return refusal_of_ply(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_TRUE(contains(with("4 0 1 2 3", "4 0 1 2 4"), "vertex 4; allowed: 0 to 3"));
  EXPECT_TRUE(contains(with("4 0 1 2 3", "4 0 1 2 -1"), "vertex -1; allowed: 0 to 3"));
  EXPECT_TRUE(contains(with("4 0 1 2 3", "4 0 1 2 x"), "found \"x\"; allowed: a number"));
  EXPECT_TRUE(contains(with("4 0 1 2 3", "1e9 0 1 2 3"), "a list of 1000000000 values"));
  EXPECT_TRUE(contains(with("float x", "floot x"), "mesh.ply: line 5 of the header has the type"));
  EXPECT_TRUE(contains(with("float x", "float a"), "have no x, y and z"));
  EXPECT_TRUE(contains(with("vertex_indices", "corners"), "have no list vertex_indices"));
  EXPECT_TRUE(contains(with("ascii", "utf8"), "is no format that is read"));
  EXPECT_TRUE(contains(with("ply\n", "obj\n"), "line 1 of the header is not \"ply\""));
}

}  // namespace
}  // namespace lacuna
