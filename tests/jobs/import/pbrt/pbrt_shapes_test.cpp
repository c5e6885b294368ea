#include "jobs/import/pbrt/pbrt_shapes.h"

#include <zlib.h>

#include <numbers>

#include "jobs/import/input_bytes.h"
#include "tests/jobs/import/pbrt/pbrt_fixture.h"

namespace lacuna {
namespace {

/// One shape of pbrt-v4 after the statements of `before`; the world is not mirrored.
ImportedShape shape_of(const std::string& shape, const std::string& before = "",
                       const std::string& film = v4_film) {
  const PbrtFolder folder;
  const auto scene = folder.import(film + "Scale -1 1 1 Camera \"perspective\" WorldBegin " +
                                   before + "\n" + shape);
  EXPECT_EQ(scene.shapes.size(), 1) << noted(scene);
  return scene.shapes.at(0);
}

/// The world's bounds of a shape.
std::array<V3d, 2> bounds_of(const ImportedShape& shape) {
  std::array<V3d, 2> out{V3d(1e30), V3d(-1e30)};
  for (const V3f& p : shape.mesh->positions) {
    const V3d q = V3d(p) * shape.to_world;
    for (int c = 0; c < 3; ++c) {
      out[0][c] = std::min(out[0][c], q[c]);
      out[1][c] = std::max(out[1][c], q[c]);
    }
  }
  return out;
}

double area_of(const ImportedShape& shape) {
  return pbrt::areas_of(*shape.mesh, shape.to_world).total;
}

/// Triangles turn about their normals.
void expect_turned_to_normals(const ImportedMesh& mesh) {
  for (const auto& t : mesh.triangles) {
    const V3f n = cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                        mesh.positions[t[2]] - mesh.positions[t[0]]);
    ASSERT_GT(dot(n, mesh.normals[t[0]]), 0);
  }
}

TEST(PbrtShapes, TriangleMeshesKeepTheirVertices) {
  const auto s = shape_of(
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 9] \"point2 uv\" [0 0 1 0 0 1 .5 "
      ".5] "
      "\"integer indices\" [0 1 2 2 1 3]");
  EXPECT_EQ(s.mesh->triangles.size(), 2);
  EXPECT_EQ(s.mesh->positions[3], V3f(0, 0, 9));
  EXPECT_EQ(s.mesh->uvs[3], V2f(.5F, .5F));
  EXPECT_FALSE(s.flipped);
  EXPECT_EQ(s.mesh->triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(PbrtShapes, WhatIsInFrontFollowsTheNormals) {
  const std::string with_normals =
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 -1 0 0 -1 0 0 -1] "
      "\"integer indices\" [0 1 2]";
  const auto s = shape_of(with_normals);
  expect_turned_to_normals(*s.mesh);
  EXPECT_FALSE(s.flipped);
  EXPECT_TRUE(shape_of(with_normals, "ReverseOrientation").flipped);
  EXPECT_FALSE(shape_of(with_normals, "ReverseOrientation", v3_film).flipped);
  EXPECT_TRUE(shape_of(triangle, "ReverseOrientation", v3_film).flipped);
  // A mirroring transform takes the front along.
  EXPECT_FALSE(shape_of(triangle, "Scale 1 1 -1").flipped);
  EXPECT_FALSE(shape_of(triangle, "ReverseOrientation ReverseOrientation").flipped);
}

TEST(PbrtShapes, MeshesAreChecked) {
  const PbrtFolder folder;
  EXPECT_NE(folder.error("Shape \"trianglemesh\"").find("\"point3 P\" is missing"),
            std::string::npos);
  const std::string points = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1] ";
  EXPECT_NE(folder.error(points).find("\"indices\" is missing"), std::string::npos);
  EXPECT_NE(folder.error(points + "\"integer indices\" [0 1 4]").find("contains 4"),
            std::string::npos);
  EXPECT_NE(folder.error(points + "\"integer indices\" [0 1 -1]").find("contains -1"),
            std::string::npos);
  EXPECT_NE(folder.error(points + "\"integer indices\" [0 1]").find("multiple of 3"),
            std::string::npos);
  EXPECT_NE(
      folder.error(points + "\"integer indices\" [0 1 2] \"point2 uv\" [0 1]").find("of \"uv\""),
      std::string::npos);
  EXPECT_NE(folder.error("Shape \"torus\"").find("shape \"torus\"; allowed"), std::string::npos);
}

TEST(PbrtShapes, SpheresAreParts) {
  const auto whole = shape_of("Shape \"sphere\" \"float radius\" 2", "Translate 1 0 0");
  EXPECT_NEAR(area_of(whole), 16 * std::numbers::pi, 1e-3);
  expect_near(bounds_of(whole)[1], V3d(3, 2, 2), 2e-3);
  // Archimedes: the area between two heights is 2 pi r h.
  const auto zone = shape_of(
      "Shape \"sphere\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" .5 \"float phimax\" "
      "90");
  EXPECT_NEAR(area_of(zone), 2 * std::numbers::pi * 2 * 1.5 / 4, .01);
  expect_near(bounds_of(zone)[0], V3d(0, 0, -1), 2e-3);
  EXPECT_NEAR(bounds_of(zone)[1].z, .5, 1e-6);
  expect_turned_to_normals(*whole.mesh);
}

TEST(PbrtShapes, OtherQuadrics) {
  const auto disk =
      shape_of("Shape \"disk\" \"float height\" 3 \"float radius\" 2 \"float innerradius\" 1");
  EXPECT_NEAR(area_of(disk), 3 * std::numbers::pi, 5e-3);
  EXPECT_NEAR(bounds_of(disk)[0].z, 3, 1e-6);
  const auto cylinder = shape_of(
      "Shape \"cylinder\" \"float radius\" 2 \"float zmin\" 1 \"float zmax\" 4 \"float phimax\" "
      "180");
  EXPECT_NEAR(area_of(cylinder), 2 * std::numbers::pi * 3, 5e-3);
  EXPECT_NEAR(bounds_of(cylinder)[0].z, 1, 1e-6);
  EXPECT_NEAR(bounds_of(cylinder)[0].y, 0, 1e-3);
  const auto cone = shape_of("Shape \"cone\" \"float radius\" 3 \"float height\" 4", "", v3_film);
  EXPECT_NEAR(area_of(cone), std::numbers::pi * 3 * 5, .02);
  const auto bowl =
      shape_of("Shape \"paraboloid\" \"float radius\" 1 \"float zmax\" 1", "", v3_film);
  EXPECT_NEAR(area_of(bowl), std::numbers::pi / 6 * (std::pow(5, 1.5) - 1), .01);
  for (const auto& s : {disk, cylinder, cone, bowl}) expect_turned_to_normals(*s.mesh);
  EXPECT_NE(PbrtFolder().error("Shape \"sphere\" \"float radius\" 0").find("above 0"),
            std::string::npos);
}

TEST(PbrtShapes, EqualOnesShareAMesh) {
  const auto scene = PbrtFolder().import(
      v4_film + "WorldBegin Shape \"sphere\" Shape \"sphere\" \"float radius\" 3 Shape \"disk\"");
  EXPECT_EQ(scene.shapes[0].mesh, scene.shapes[1].mesh);
  EXPECT_NE(scene.shapes[0].mesh, scene.shapes[2].mesh);
}

const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n2 0 0\n0 2 0\n3 0 1 2\n";

TEST(PbrtShapes, PlyMeshesMayBeCompressed) {
  const PbrtFolder folder;
  folder.write("a.ply", ply);
  const auto packed = (folder.path() / "b.ply.gz").string();
  gzFile file = gzopen(packed.c_str(), "wb");
  gzwrite(file, ply.data(), static_cast<unsigned>(ply.size()));
  gzclose(file);
  const auto scene = folder.import(
      v4_film +
      "WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\" "
      "Shape \"plymesh\" \"string filename\" [\"b.ply.gz\"] Shape \"plymesh\" \"string "
      "filename\" \"a.ply\"");
  ASSERT_EQ(scene.shapes.size(), 3);
  EXPECT_EQ(scene.shapes[0].mesh->positions, scene.shapes[1].mesh->positions);
  EXPECT_EQ(scene.shapes[0].mesh, scene.shapes[2].mesh);
  const std::string bytes = read_unzipped(packed, 1000);
  EXPECT_EQ(bytes, ply);
  EXPECT_THROW(read_unzipped(packed, ply.size() - 1), SceneError);
}

TEST(PbrtShapes, MissingFilesAreCountedOrSkipped) {
  const std::string text = v4_film +
                           "WorldBegin\nShape \"plymesh\" \"string filename\" \"a.ply\"\n"
                           "Shape \"plymesh\" \"string filename\" \"b.ply\" Shape \"disk\"";
  EXPECT_EQ(PbrtFolder().error(text),
            "scene.pbrt:3: Shape \"plymesh\": file \"a.ply\" does not exist (and 1 more); "
            "--missing skip leaves such files out");
  const auto scene = PbrtFolder().import(text, MissingFiles::skip);
  EXPECT_EQ(scene.shapes.size(), 1);
  EXPECT_NE(noted(scene).find("\"b.ply\" does not exist"), std::string::npos);
}

TEST(PbrtShapes, DamagedPlyNamesTheStatement) {
  const PbrtFolder folder;
  folder.write("a.ply", ply.substr(0, 60));
  EXPECT_EQ(folder.error("\nShape \"plymesh\" \"string filename\" \"a.ply\"").substr(0, 13),
            "scene.pbrt:2:");
}

TEST(PbrtShapes, BilinearPatches) {
  const auto flat = shape_of("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 2 0 0 0 1 0 2 1 0]");
  EXPECT_EQ(flat.mesh->triangles.size(), 2);
  EXPECT_NEAR(area_of(flat), 2, 1e-6);
  EXPECT_EQ(flat.mesh->normals[0], V3f(0, 0, 1));  // dp/du x dp/dv
  EXPECT_EQ(flat.mesh->uvs[3], V2f(1, 1));
  const auto saddle = shape_of("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]");
  for (const V3f& p : saddle.mesh->positions) EXPECT_NEAR(p.z, p.x * p.y, 1e-6);  // z = xy
  expect_turned_to_normals(*saddle.mesh);
}

/// Vertices of an octahedron and of what Loop's scheme makes of it keep its symmetry; a corner's
/// limit is p (1 - 4 w) + w (sum of its neighbours, 0), w = 1 / (4 + 3 / (8 b)), b = 3 / 32.
TEST(PbrtShapes, LoopSubdivisionOfAnOctahedron) {
  const auto octahedron = [](int levels) {
    return shape_of("Shape \"loopsubdiv\" \"integer levels\" " + std::to_string(levels) +
                    " \"point3 P\" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1] \"integer indices\" "
                    "[0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5]");
  };
  const double limit = 1 - 4.0 / (4 + 3 / (8 * 3.0 / 32));
  for (const int levels : {0, 1, 3}) {
    const auto s = octahedron(levels);
    EXPECT_EQ(s.mesh->triangles.size(), 8 * std::pow(4, levels));
    expect_near(V3d(s.mesh->positions[0]), V3d(limit, 0, 0), 1e-6);
    expect_near(V3d(s.mesh->normals[0]), V3d(1, 0, 0), 1e-6);
    expect_turned_to_normals(*s.mesh);
    EXPECT_EQ(s.mesh->positions.size(), s.mesh->triangles.size() / 2 + 2);  // Euler
  }
}

/// A flat square stays flat, and its border a cubic B-spline within it: at a corner 2/3 of it and
/// 1/6 of each neighbour. At a finite level pbrt takes 3/5 and 1/5.
TEST(PbrtShapes, LoopSubdivisionKeepsBorders) {
  const auto square = [](int levels) {
    return shape_of("Shape \"loopsubdiv\" \"integer levels\" " + std::to_string(levels) +
                    " \"point3 P\" [0 0 0 4 0 0 4 4 0 0 4 0] \"integer indices\" [0 1 2 0 2 3]");
  };
  EXPECT_NEAR(bounds_of(square(2))[1].z, 0, 1e-6);
  expect_near(V3d(square(0).mesh->positions[0]), V3d(.8, .8, 0), 1e-5);
  expect_near(V3d(square(5).mesh->positions[0]), V3d(2 / 3.0, 2 / 3.0, 0), 1e-3);
}

/// A small file is not to make a large mesh.
TEST(PbrtShapes, LoopSubdivisionHasAnEnd) {
  const auto scene = PbrtFolder().import(
      v4_film +
      "WorldBegin Shape \"loopsubdiv\" \"integer levels\" 12 \"point3 P\" [0 0 0 1 0 0 0 1 0] "
      "\"integer indices\" [0 1 2]");
  EXPECT_EQ(scene.shapes[0].mesh->triangles.size(), 1 << 16);
  EXPECT_NE(noted(scene).find("8 of 12 levels"), std::string::npos);
}

TEST(PbrtShapes, InstancesShareMeshes) {
  const auto scene = PbrtFolder().import(
      v4_film +
      "Scale -1 1 1 Camera \"perspective\" WorldBegin ObjectBegin \"o\" Translate 1 0 0 " +
      triangle + "ObjectEnd Scale 2 2 2 ObjectInstance \"o\" Translate 0 3 0 ObjectInstance \"o\"");
  ASSERT_EQ(scene.shapes.size(), 2);
  EXPECT_EQ(scene.shapes[0].mesh, scene.shapes[1].mesh);
  expect_near(V3d(0, 0, 0) * scene.shapes[0].to_world, V3d(2, 0, 0));
  expect_near(V3d(0, 0, 0) * scene.shapes[1].to_world, V3d(2, 6, 0));
  EXPECT_NE(PbrtFolder().error("ObjectInstance \"x\"").find("no object \"x\""), std::string::npos);
  EXPECT_NE(PbrtFolder().error("ObjectBegin \"a\" ObjectBegin \"b\"").find("object within"),
            std::string::npos);
}

TEST(PbrtShapes, FilesOutsideOfTheFolderAreMissing) {
  const std::string text = v4_film +
                           "WorldBegin Shape \"plymesh\" \"string filename\" \"../a.ply\" Shape "
                           "\"disk\" Shape \"disk\" \"float alpha\" 1";
  EXPECT_NE(PbrtFolder().error(text).find(
                "file \"../a.ply\" lies outside of the folder of the scene file"),
            std::string::npos);
  EXPECT_EQ(PbrtFolder().import(text, MissingFiles::skip).shapes.size(), 2);
}

TEST(PbrtShapes, WithoutTrianglesTheyAreNoted) {
  const PbrtFolder folder;
  folder.write("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
               "property float z\nend_header\n0 0 0\n");
  const auto scene = folder.import(v4_film +
                                   "WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\" "
                                   "Shape \"cylinder\" \"float zmin\" 1 \"float zmax\" 1");
  EXPECT_TRUE(scene.shapes.empty());
  EXPECT_EQ(noted(scene),
            "Shape \"plymesh\": it has no triangles\nShape \"cylinder\": it has no area\n");
}

}  // namespace
}  // namespace lacuna
