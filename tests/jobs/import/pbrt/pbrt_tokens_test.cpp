#include "jobs/import/pbrt/pbrt_tokens.h"

#include "jobs/import/pbrt/pbrt_parameters.h"
#include "tests/jobs/import/pbrt/pbrt_fixture.h"

namespace lacuna {
namespace {

std::string tokens_of(const PbrtFolder& folder, const std::string& text) {
  pbrt::Tokens tokens(folder.write("a.pbrt", text));
  std::string out;
  while (const auto t = tokens.next()) {
    out += t->kind == pbrt::Token::Kind::text ? "<" + std::string(t->text) + ">"
                                              : std::string(t->text);
    out += "@" + std::to_string(t->place.line) + " ";
  }
  return out;
}

TEST(PbrtTokens, AreWordsTextsAndBracketsWithLines) {
  const PbrtFolder folder;
  EXPECT_EQ(tokens_of(folder, "A \"b c\" [1 -2.5e3]# ]\n\n\"d\\\"\\n\" E#x"),
            "A@1 <b c>@1 [@1 1@1 -2.5e3@1 ]@1 <d\"\n>@3 E@3 ");
  EXPECT_EQ(tokens_of(folder, " # nothing"), "");
}

TEST(PbrtTokens, ErrorsNameFileAndLine) {
  const PbrtFolder folder;
  EXPECT_EQ(folder.error(v4_film + "Fil \"x\"\n"), "scene.pbrt:2: unknown statement \"Fil\"");
  EXPECT_NE(folder.error(v4_film + "\nCamera \"per\n\"").find("scene.pbrt:3: a text in quotes"),
            std::string::npos);
  EXPECT_NE(folder.error("Film \"a\\q\"").find("\"\\q\" in a text"), std::string::npos);
  EXPECT_NE(folder.error(v4_film + "WorldBegin \"x\"").find("found x; expected a statement"),
            std::string::npos);
  EXPECT_NE(folder.error("SurfaceIntegrator \"path\"").find("pbrt-v2"), std::string::npos);
}

TEST(PbrtTokens, IncludesAreReadInPlace) {
  const PbrtFolder folder;
  folder.write("geometry/b.pbrt", "Translate 0 0 5 # no line end");
  folder.write("geometry/c.pbrt", triangle);
  const auto scene = folder.import(v4_film +
                                   "WorldBegin Include \"geometry/b.pbrt\"\n"
                                   "Include \"geometry/c.pbrt\" Translate 1 0 0 " +
                                   triangle);
  ASSERT_EQ(scene.shapes.size(), 2);
  EXPECT_EQ(scene.shapes[0].place, "geometry/c.pbrt:1");
  EXPECT_EQ(scene.shapes[0].to_world[3][2], 5);
  EXPECT_EQ(scene.shapes[1].to_world[3][0], -1);  // mirrored
}

TEST(PbrtTokens, ImportLeavesTheStateAlone) {
  const PbrtFolder folder;
  folder.write("b.pbrt", "Translate 0 0 5 Material \"conductor\" " + triangle);
  const auto scene = folder.import(v4_film + "WorldBegin Import \"b.pbrt\" " + triangle);
  ASSERT_EQ(scene.shapes.size(), 2);
  EXPECT_EQ(scene.shapes[0].to_world[3][2], 5);
  EXPECT_EQ(scene.shapes[1].to_world[3][2], 0);
  EXPECT_EQ(scene.shapes[1].material->type, ImportedMaterial::Type::diffuse);
}

TEST(PbrtTokens, IncludesMayNotRunInCirclesOrLeaveTheFolder) {
  const PbrtFolder folder;
  folder.write("b.pbrt", "Include \"scene.pbrt\"");
  EXPECT_NE(folder.error(v4_film + "Include \"b.pbrt\"").find("includes itself"),
            std::string::npos);
  EXPECT_NE(folder.error("Include \"../x.pbrt\"").find("within the folder"), std::string::npos);
  EXPECT_NE(folder.error("Include \"/etc/passwd\"").find("within the folder"), std::string::npos);
  std::filesystem::create_symlink("/etc", folder.path() / "link");
  EXPECT_NE(folder.error("Include \"link/passwd\"").find("a link out of the folder"),
            std::string::npos);
  for (int i = 0; i < 40; ++i) {
    folder.write("d" + std::to_string(i) + ".pbrt",
                 "Include \"d" + std::to_string(i + 1) + ".pbrt\"");
  }
  EXPECT_NE(folder.error("Include \"d0.pbrt\"").find("nested 32 deep"), std::string::npos);
}

TEST(PbrtTokens, AttributesEndWhereTheyBegan) {
  const PbrtFolder folder;
  EXPECT_NE(folder.error("AttributeBegin TransformBegin AttributeEnd").find("does not end before"),
            std::string::npos);
  EXPECT_NE(folder.error("AttributeEnd").find("nothing begins"), std::string::npos);
  EXPECT_NE(folder.error("AttributeBegin").find("does not end"), std::string::npos);
  std::string deep;
  for (int i = 0; i < 300; ++i) deep += "AttributeBegin ";
  EXPECT_NE(folder.error(deep).find("nested 256 deep"), std::string::npos);
}

TEST(PbrtTokens, SeedsOfTheFuzzTargetAreScenes) {
  for (const char* name : {"v3.pbrt", "v4.pbrt"}) {
    const auto file = std::filesystem::path(LACUNA_SOURCE_DIR) / "tests/fuzz/corpus/pbrt" / name;
    EXPECT_GT(read_pbrt(file, MissingFiles::skip).shapes.size(), 2) << name;
  }
}

TEST(PbrtParameters, HaveTypes) {
  const PbrtFolder folder;
  pbrt::Tokens tokens(folder.write(
      "a.pbrt",
      "\"float fov\" 39 \"float a\" [1 2] \"bool b\" true \"bool c\" \"false\" \"rgb d\" [1 2 3] "
      "\"spectrum e\" \"metal-Au-eta\" \"point P\" [1 2 3 4 5 6] \"integer i\" [3] next"));
  const pbrt::Parameters p(tokens, {}, "test");
  EXPECT_EQ(p.number("fov", 0), 39);
  EXPECT_TRUE(p.boolean("b", false));
  EXPECT_FALSE(p.boolean("c", true));
  EXPECT_EQ(p.find_spectrum("d")->numbers.size(), 3);
  EXPECT_EQ(p.find_spectrum("e")->texts[0], "metal-Au-eta");
  EXPECT_EQ(p.groups("P", 3, {"point3"}).size(), 6);
  EXPECT_EQ(p.integer("i", 0, 0, 5), 3);
  EXPECT_EQ(p.number("absent", 7), 7);
  ASSERT_EQ(p.unused().size(), 1);
  EXPECT_EQ(p.unused()[0]->name, "a");
  EXPECT_THROW(p.number("a", 0), SceneError);
  EXPECT_THROW(p.integer("i", 0, 4, 5), SceneError);
  EXPECT_EQ(tokens.next()->text, "next");
}

TEST(PbrtParameters, OtherValuesAreRefused) {
  const PbrtFolder folder;
  const auto error = [&](const std::string& p) {
    return folder.error("Camera \"perspective\" " + p);
  };
  EXPECT_NE(error("\"flot fov\" 1").find("allowed: \"TYPE NAME\""), std::string::npos);
  EXPECT_NE(error("\"float\" 1").find("allowed: \"TYPE NAME\""), std::string::npos);
  EXPECT_NE(error("\"float fov\" nan").find("finite numbers"), std::string::npos);
  EXPECT_NE(error("\"float fov\" 1e999").find("finite numbers"), std::string::npos);
  EXPECT_NE(error("\"float fov\" \"x\"").find("finite numbers"), std::string::npos);
  EXPECT_NE(error("\"string s\" 3").find("texts in quotes"), std::string::npos);
  EXPECT_NE(error("\"float fov\" [1").find("] is missing"), std::string::npos);
  EXPECT_NE(error("\"float fov\" 190").find("between 0 and 180"), std::string::npos);
}

TEST(PbrtParameters, UnusedOnesAreNoted) {
  const PbrtFolder folder;
  const auto scene = folder.import(v4_film + "Camera \"perspective\" \"float nonsense\" 3");
  EXPECT_EQ(noted(scene), "Camera \"perspective\": parameter \"float nonsense\"\n");
  EXPECT_EQ(scene.notes[0].treatment, "left out");
  EXPECT_EQ(scene.notes[0].place, "scene.pbrt:2");
}

TEST(PbrtParameters, TheLastOfOneNameCounts) {
  const auto scene = PbrtFolder().import(
      "Film \"image\" \"integer xresolution\" 1920 \"integer yresolution\" 8\n\"integer "
      "xresolution\" [16]");
  EXPECT_EQ(scene.picture.resolution, (std::array<int, 2>{16, 8}));
  EXPECT_EQ(noted(scene), "Film \"image\": parameter \"integer xresolution\"\n");
  EXPECT_EQ(scene.notes[0].place, "scene.pbrt:1");
}

/// Also where the file lies in the working directory, so that its path has no folder.
TEST(PbrtTokens, PlacesNameTheFile) {
  const PbrtFolder folder;
  folder.write("here.pbrt", "\nScale 1 0");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  std::string message;
  try {
    read_pbrt("here.pbrt", MissingFiles::refuse);
  } catch (const SceneError& e) {
    message = e.what();
  }
  std::filesystem::current_path(before);
  EXPECT_EQ(message.substr(0, 12), "here.pbrt:2:");
}

}  // namespace
}  // namespace lacuna
