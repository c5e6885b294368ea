#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>

#include "jobs/import/mesh_normals.h"
#include "jobs/import/mitsuba/mesh_files.h"
#include "jobs/import/mitsuba/read_mitsuba.h"
#include "renderer/core/scene_error.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

template <class T>
void append_value(std::string& to, T value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  out.resize(size);
  return out;
}

/// A triangle with texture coordinates, its vertices at z = `z`.
std::string serialized_triangle(std::uint16_t version, double z, std::uint64_t claimed = 3) {
  std::string body;
  const bool doubles = version == 4;
  append_value(body, std::uint32_t(doubles ? 0x2002 : 0x1002));
  if (version == 4) body += std::string("tri\0", 4);
  append_value(body, claimed);
  append_value(body, std::uint64_t{1});
  for (const double v : {0., 0., z, 1., 0., z, 0., 1., z, .25, .5, 1., 0., 0., 1.}) {
    if (doubles) append_value(body, v);
    if (!doubles) append_value(body, static_cast<float>(v));
  }
  for (const std::uint32_t i : {0U, 1U, 2U}) append_value(body, i);
  std::string file;
  append_value(file, std::uint16_t{0x041C});
  append_value(file, version);
  return file + deflated(body);
}

std::string serialized_file(std::uint16_t version) {
  const std::string first = serialized_triangle(version, 1),
                    second = serialized_triangle(version, 2);
  std::string file = first + second;
  for (const std::uint64_t offset : {std::uint64_t{0}, std::uint64_t{first.size()}}) {
    if (version == 4) append_value(file, offset);
    if (version == 3) append_value(file, static_cast<std::uint32_t>(offset));
  }
  append_value(file, std::uint32_t{2});
  return file;
}

ImportedMesh serialized_of(const std::string& file, std::uint64_t index) {
  return mitsuba::serialized_mesh({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()},
                                  index, "mesh.serialized");
}

TEST(MitsubaFiles, SerializedMeshesOfBothVersions) {
  for (const std::uint16_t version : {std::uint16_t{3}, std::uint16_t{4}}) {
    const std::string file = serialized_file(version);
    for (const std::uint64_t index : {0U, 1U}) {
      const ImportedMesh mesh = serialized_of(file, index);
      ASSERT_EQ(mesh.positions.size(), 3U);
      EXPECT_EQ(mesh.positions[1], V3f(1, 0, static_cast<float>(index + 1)));
      ASSERT_EQ(mesh.uvs.size(), 3U);
      EXPECT_EQ(mesh.uvs[0], V2f(.25F, .5F));
      EXPECT_TRUE(mesh.normals.empty());
    }
    EXPECT_TRUE(contains(message_of<SceneError>([&] { serialized_of(file, 2); }),
                         "mesh 2 is asked for; allowed: 0 to 1"));
    for (std::size_t n = 0; n < file.size(); n += 3) {
      EXPECT_THROW(serialized_of(file.substr(0, n), 0), SceneError) << n;
    }
  }
}

TEST(MitsubaFiles, SerializedMeshMayNotClaimMoreThanItHolds) {
  std::string file = serialized_triangle(4, 1, std::uint64_t{1} << 60);
  append_value(file, std::uint64_t{0});
  append_value(file, std::uint32_t{1});
  EXPECT_TRUE(contains(message_of<SceneError>([&] { serialized_of(file, 0); }), "it claims"));
}

ImportedMesh only_part(const std::string& obj) {
  const auto parts = mitsuba::obj_file(obj, "a.obj").parts;
  EXPECT_EQ(parts.size(), 1U);
  return parts.at(0).mesh;
}

TEST(MitsubaFiles, ObjSharesCornersAndRefusesMissingVertices) {
  const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1\n";
  const ImportedMesh mesh = only_part(quad + "f 1/1 2/1 3/2\nf 1/1 3/2 4/1\n");
  EXPECT_EQ(mesh.positions.size(), 4U);
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.uvs[2], V2f(1, 1));
  EXPECT_TRUE(contains(message_of<SceneError>([&] { only_part(quad + "f 1/1 2/1 9/2\n"); }),
                       "a.obj: a face names vertex 9 of 4"));
}

/// Two triangles of the material "red", one of "blue", one of none.
const std::string four_faces =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nusemtl red\nf 1 3 4\nusemtl blue\nf 1 2 "
    "4\nusemtl red\nf 2 3 4\n";

/// "MATERIAL TRIANGLES" of each shape; its parameters stand in `inside`.
std::vector<std::string> parts_of(const TemporaryFolder& folder, const std::string& inside,
                                  const std::string& version = "0.6.0") {
  const ImportedScene scene = read_mitsuba(
      folder.write("scene.xml", "<scene version='" + version +
                                    "'><shape type='obj'><string name='filename' " +
                                    "value='models/a.obj'/>" + inside + "</shape></scene>"),
      MissingFiles::refuse);
  std::vector<std::string> out;
  for (const ImportedShape& s : scene.shapes) {
    out.push_back(fmt::format("{} {}", s.material->name, s.mesh->triangles.size()));
  }
  return out;
}

TEST(MitsubaFiles, ObjKeepsTheBsdfsOfItsMaterials) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "models");
  folder.write("models/a.obj", four_faces);
  const std::string red = "<bsdf type='diffuse' name='red' id='r'/>",
                    blue = "<bsdf type='plastic' name='blue' id='b'/>",
                    others = "<bsdf type='conductor' id='o'/>";
  using Parts = std::vector<std::string>;
  EXPECT_EQ(parts_of(folder, red + blue + others), (Parts{"o 1", "r 2", "b 1"}));
  EXPECT_EQ(parts_of(folder, blue), (Parts{"default 1", "default 2", "b 1"}));
  EXPECT_EQ(parts_of(folder, others), (Parts{"o 1", "o 2", "o 1"}));
}

TEST(MitsubaFiles, ObjReadsItsMtlWhereTheSceneHasNoBsdf) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "models");
  folder.write("models/a.obj", "mtllib a.mtl\n" + four_faces);
  folder.write("models/map.png", std::string("no picture yet"));
  folder.write("models/a.mtl",
               std::string("newmtl red\nKd 1 0.5 0\nKs 0.5 0.5 0.5\nNs 20\nillum 2\nd 0.25\n"
                           "newmtl blue\nKd 0 0 1\nmap_Kd map.png\n"));
  using Parts = std::vector<std::string>;
  EXPECT_EQ(parts_of(folder, ""), (Parts{"default 1", "red 2", "blue 1"}));
  EXPECT_EQ(parts_of(folder, "<bsdf type='conductor' id='o'/>"), (Parts{"o 1", "o 2", "o 1"}));
  EXPECT_EQ(parts_of(folder, "<boolean name='loadMaterials' value='false'/>"),
            (Parts{"default 1", "default 2", "default 1"}));
  EXPECT_EQ(parts_of(folder, "", "3.0.0"), (Parts{"default 1", "default 2", "default 1"}));

  const ImportedScene old = read_mitsuba(
      folder.write("scene.xml",
                   std::string("<scene version='0.6.0'><shape type='obj'><string name='filename' "
                               "value='models/a.obj'/></shape></scene>")),
      MissingFiles::refuse);
  const ImportedMaterial& red = *old.shapes[1].material;
  EXPECT_EQ(red.type, ImportedMaterial::Type::phong);
  EXPECT_NEAR(red.diffuse.value.y, 0.21404, 1e-4);  // 0.5 by sRGB's curve
  EXPECT_EQ(red.exponent, 20);
  EXPECT_EQ(red.opacity.value.x, 0.25F);
  EXPECT_TRUE(red.one_sided);
  ASSERT_NE(old.shapes[2].material->diffuse.texture, nullptr);
  EXPECT_EQ(old.shapes[2].material->diffuse.texture->file.filename(), "map.png");
}

TEST(MitsubaFiles, FrontIsWhereNormalsPoint) {
  ImportedMesh mesh = only_part("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n");
  orient_by_normals(mesh);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
  mesh.normals.clear();
  add_smooth_normals(mesh);
  EXPECT_EQ(mesh.normals[0], V3f(0, 0, -1));
}

TEST(MitsubaFiles, SpectraOfFilesAndOfPlugins) {
  const TemporaryFolder folder;
  folder.write("eta.spd", std::string("# a metal\n 400 1.5\n500 2 # mid\n\n700 3\n"));
  const auto radiance = [&](const std::string& spectrum) {
    const auto file = folder.write(
        "scene.xml", "<scene version='3.0.0'><shape type='cube'><emitter type='area'>" + spectrum +
                         "</emitter></shape></scene>");
    return read_mitsuba(file, MissingFiles::refuse).shapes.at(0).radiance->value;
  };
  const Rgb list = radiance("<spectrum name='radiance' value='400:1.5, 500:2, 700:3'/>");
  EXPECT_GT(list.x, list.z);
  EXPECT_EQ(radiance("<spectrum name='radiance' filename='eta.spd'/>"), list);
  EXPECT_EQ(radiance("<spectrum name='radiance' type='irregular'><string name='wavelengths' "
                     "value='400, 500, 700'/><string name='values' value='1.5, 2, 3'/></spectrum>"),
            list);
  EXPECT_EQ(radiance("<spectrum name='radiance' type='d65'><float name='scale' "
                     "value='3'/></spectrum>"),
            Rgb(3));
  EXPECT_EQ(radiance("<blackbody name='radiance' temperature='4000K' scale='2'/>"),
            radiance("<spectrum name='radiance' type='blackbody'><float name='temperature' "
                     "value='4000'/><float name='scale' value='2'/></spectrum>"));
  EXPECT_TRUE(contains(
      message_of<SceneError>([&] { radiance("<spectrum name='radiance' filename='x.spd'/>"); }),
      "x.spd does not exist"));
}

constexpr const char* named_files = R"(<scene version="0.6.0"><sensor type="orthographic"/>
  <shape type="obj"><string name="filename" value="there.obj"/>
    <bsdf type="diffuse"><texture type="bitmap" name="reflectance">
      <string name="filename" value="gone.png"/></texture></bsdf></shape>
  <shape type="ply"><string name="filename" value="gone.ply"/></shape>
</scene>)";

TEST(MitsubaFiles, MissingOnesAreNamedOrSkipped) {
  const TemporaryFolder folder;
  folder.write("there.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  folder.write("empty.obj", std::string("# nothing\n"));
  const ImportedScene empty = read_mitsuba(
      folder.write("e.xml", std::string("<scene version='0.6.0'><sensor type='orthographic'/>"
                                        "<shape type='obj'><string name='filename' "
                                        "value='empty.obj'/></shape></scene>")),
      MissingFiles::refuse);
  ASSERT_EQ(empty.notes.size(), 1U);
  EXPECT_EQ(empty.notes[0].how, "empty.obj has no triangles");
  const auto file = folder.write("scene.xml", std::string(named_files));
  const std::string refusal =
      message_of<SceneError>([&] { read_mitsuba(file, MissingFiles::refuse); });
  EXPECT_TRUE(contains(refusal, "scene.xml:3: gone.png does not exist (and 1 more)")) << refusal;
  const ImportedScene scene = read_mitsuba(file, MissingFiles::skip);
  EXPECT_EQ(scene.shapes.size(), 1U);
  ASSERT_EQ(scene.notes.size(), 2U);
  EXPECT_EQ(scene.notes[1].how, "gone.ply is missing");
}

std::string refusal_of_include(const TemporaryFolder& folder, const std::string& included,
                               const std::string& content) {
  folder.write("a.xml", "<scene version='0.6.0'>\n<include filename='" + included + "'/></scene>");
  folder.write("b.xml", content);
  return message_of<SceneError>([&] { read_mitsuba(folder / "a.xml", MissingFiles::refuse); });
}

TEST(MitsubaFiles, IncludesStayInTheFolderAndEnd) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      contains(refusal_of_include(folder, "b.xml", "<scene><include filename='a.xml'/></scene>"),
               "b.xml:1: include includes \"a.xml\", which includes it: a circle"));
  for (const char* outside : {"../b.xml", "/etc/passwd", "..\\b.xml", "x/../../b.xml"}) {
    EXPECT_TRUE(contains(refusal_of_include(folder, outside, ""),
                         "allowed: files in the folder of the scene"))
        << outside;
  }
  std::filesystem::create_symlink("/etc/hostname", folder / "link.xml");
  EXPECT_TRUE(contains(refusal_of_include(folder, "link.xml", ""), "allowed: files in the folder"));
  EXPECT_TRUE(contains(refusal_of_include(folder, "c.xml", ""), "cannot find \"c.xml\""));
}

/// Without normals in the file the front is where the placed triangles are counter-clockwise.
TEST(MitsubaFiles, MirroredMeshesShowTheSideOfTheirWinding) {
  const TemporaryFolder folder;
  folder.write("bare.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  folder.write("with.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n"));
  const auto flipped = [&](const std::string& mesh, const std::string& more) {
    const auto file = folder.write(
        "scene.xml", "<scene version='0.6.0'><shape type='obj'><string name='filename' value='" +
                         mesh + "'/><transform name='toWorld'><scale x='-1'/></transform>" + more +
                         "</shape></scene>");
    return read_mitsuba(file, MissingFiles::refuse).shapes.at(0).flipped;
  };
  EXPECT_TRUE(flipped("bare.obj", ""));
  EXPECT_FALSE(flipped("with.obj", ""));
  EXPECT_TRUE(flipped("with.obj", "<boolean name='faceNormals' value='true'/>"));
  EXPECT_TRUE(flipped("with.obj", "<boolean name='flipNormals' value='true'/>"));
}

TEST(MitsubaFiles, HostileXmlIsRefused) {
  const auto refusal = [](const std::string& xml) {
    return message_of<SceneError>([&] { read_mitsuba_text(xml); });
  };
  EXPECT_TRUE(contains(refusal("<!DOCTYPE s [<!ENTITY a 'b'><!ENTITY c '&a;&a;'>]><scene>&c;"
                               "</scene>"),
                       "document type"));
  std::string deep = "<scene>";
  for (int i = 0; i < 70; ++i) deep += "<shape>";
  for (int i = 0; i < 70; ++i) deep += "</shape>";
  EXPECT_TRUE(contains(refusal(deep + "</scene>"), "nested more than 64 deep"));
  EXPECT_TRUE(contains(refusal("<scene>\n<shape></scene>"), "scene.xml:2: no XML"));
  std::string doubling = "<scene><default name='a0' value='xxxxxxxxxxxxxxxx'/>";
  for (int i = 0; i < 20; ++i) {
    const std::string next = std::to_string(i + 1), now = std::to_string(i);
    doubling += "<default name='a" + next + "' value='$a" + now + ";$a" + now + "'/>";
  }
  EXPECT_TRUE(contains(refusal(doubling + "</scene>"), "longer than 65536 bytes"));
  // Groups of which each has eight instances of the one before: 8^7.
  std::string groups = "<scene><shape type='shapegroup' id='g0'/>";
  for (int i = 1; i < 8; ++i) {
    groups += "<shape type='shapegroup' id='g" + std::to_string(i) + "'>";
    for (int k = 0; k < 8; ++k) {
      groups += "<shape type='instance'><ref id='g" + std::to_string(i - 1) + "'/></shape>";
    }
    groups += "</shape>";
  }
  EXPECT_TRUE(contains(refusal(groups + "<shape type='instance'><ref id='g7'/></shape></scene>"),
                       "is one of more than 2^20 shapes"));
  EXPECT_TRUE(contains(refusal("<scene><bsdf type='twosided' id='a'><ref id='b'/></bsdf><bsdf "
                               "type='twosided' id='b'><ref id='a'/></bsdf><shape type='cube'>"
                               "<ref id='a'/></shape></scene>"),
                       "is within itself: a circle"));
}

TEST(MitsubaFiles, WhatLiesOutsideOfTheFolderIsMissing) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in");
  folder.write("out.ply", std::string("no mesh"));
  const auto file = folder.write(
      "in/scene.xml", std::string("<scene version='3.0.0'><sensor type='orthographic'/><shape "
                                  "type='ply'><string name='filename' value='../out.ply'/></shape>"
                                  "<shape type='cube'/></scene>"));
  EXPECT_TRUE(contains(message_of<SceneError>([&] { read_mitsuba(file, MissingFiles::refuse); }),
                       "../out.ply lies outside of the folder of the scene; --missing skip"));
  EXPECT_EQ(read_mitsuba(file, MissingFiles::skip).shapes.size(), 1U);
}

TEST(MitsubaFiles, FurtherFoldersAreSearched) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "data");
  folder.write("data/a.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  const auto file = folder.write(
      "scene.xml", std::string("<scene version='3.0.0'><path value='data'/><path value='../x'/>"
                               "<sensor type='orthographic'/><shape type='obj'><string "
                               "name='filename' value='a.obj'/></shape></scene>"));
  const ImportedScene scene = read_mitsuba(file, MissingFiles::refuse);
  EXPECT_EQ(scene.shapes.size(), 1U);
  ASSERT_EQ(scene.notes.size(), 1U);
  EXPECT_EQ(scene.notes[0].how, "\"../x\" lies outside of the folder of the scene");
}

TEST(MitsubaFiles, MissingSpectraLeaveTheDefault) {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "scene.xml",
      std::string("<scene version='3.0.0'><sensor type='orthographic'/><shape type='cube'><bsdf "
                  "type='conductor'><string name='material' value='Au'/>\n<spectrum name='eta' "
                  "filename='a.spd'/></bsdf></shape></scene>"));
  EXPECT_TRUE(contains(message_of<SceneError>([&] { read_mitsuba(file, MissingFiles::refuse); }),
                       "scene.xml:2: a.spd does not exist"));
  const ImportedScene scene = read_mitsuba(file, MissingFiles::skip);
  EXPECT_NEAR(scene.shapes.at(0).material->eta.x, .143124 / 1.000277, 1e-6);
  ASSERT_EQ(scene.notes.size(), 1U);
  EXPECT_EQ(scene.notes[0].how, "a.spd is missing");
}

}  // namespace
}  // namespace lacuna
