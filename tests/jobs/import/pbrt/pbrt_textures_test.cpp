#include "jobs/import/pbrt/pbrt_textures.h"

#include "tests/jobs/import/pbrt/pbrt_fixture.h"

namespace lacuna {
namespace {

struct TexturedScene {
  ImportedValue diffuse;
  std::shared_ptr<const ImportedMaterial> material;
  std::optional<ImportedValue> opacity;
  std::string notes;
};

/// A triangle whose reflectance is the texture "t".
TexturedScene textured(const std::string& statements, bool v3 = false,
                       MissingFiles missing = MissingFiles::refuse) {
  const PbrtFolder folder;
  folder.write("a.png", "not read here");
  folder.write("b.exr", "not read here");
  const auto scene =
      folder.import((v3 ? v3_film : v4_film) + "WorldBegin " + statements +
                        (v3 ? " Material \"matte\" \"texture Kd\" \"t\"\n"
                            : " Material \"diffuse\" \"texture reflectance\" \"t\"\n") +
                        triangle,
                    missing);
  const auto material = scene.shapes.at(0).material;
  return {material->diffuse, material, {}, noted(scene)};
}

std::string spectrum_texture(const std::string& name, const std::string& pattern) {
  return "Texture \"" + name + "\" \"spectrum\" " + pattern + "\n";
}

TEST(PbrtTextures, Pictures) {
  const auto plain = textured(spectrum_texture("t", "\"imagemap\" \"string filename\" \"a.png\""));
  ASSERT_TRUE(plain.diffuse.texture);
  EXPECT_EQ(plain.diffuse.texture->file.filename(), "a.png");
  EXPECT_TRUE(plain.diffuse.texture->srgb);
  EXPECT_EQ(plain.diffuse.value, Rgb(1, 1, 1));
  EXPECT_EQ(plain.notes, "");
  const auto all = textured(spectrum_texture(
      "t",
      "\"imagemap\" \"string filename\" \"a.png\" \"string encoding\" \"gamma 1.8\" \"string "
      "wrap\" "
      "\"clamp\" \"float uscale\" 2 \"float vscale\" 3 \"float udelta\" .5 \"float vdelta\" .25 "
      "\"float scale\" .5 \"bool invert\" true \"string filter\" \"point\""));
  const ImportedTexture& t = *all.diffuse.texture;
  EXPECT_FALSE(t.srgb);
  EXPECT_EQ(t.gamma, 1.8);
  EXPECT_EQ(t.wrap[1], ImportedTexture::Wrap::clamp);
  EXPECT_EQ(t.scale, V2d(2, 3));
  EXPECT_EQ(t.offset, V2d(.5, .25));
  EXPECT_TRUE(t.inverted);
  EXPECT_TRUE(t.nearest);
  EXPECT_EQ(all.diffuse.value, Rgb(.5F, .5F, .5F));
  EXPECT_EQ(all.notes, "");
}

TEST(PbrtTextures, EncodingsFollowTheFileUnlessStated) {
  const auto is_srgb = [](const std::string& parameters, bool v3 = false) {
    return textured(spectrum_texture("t", "\"imagemap\" \"string filename\" " + parameters), v3)
        .diffuse.texture->srgb;
  };
  EXPECT_FALSE(is_srgb("\"b.exr\""));
  EXPECT_FALSE(is_srgb("\"a.png\" \"string encoding\" \"linear\""));
  EXPECT_TRUE(is_srgb("\"a.png\"", true));
  EXPECT_FALSE(is_srgb("\"a.png\" \"bool gamma\" \"false\"", true));
  EXPECT_NE(
      PbrtFolder().error("Texture \"t\" \"float\" \"imagemap\"").find("\"filename\" is missing"),
      std::string::npos);
}

TEST(PbrtTextures, ProductsOfAPictureAndANumber) {
  const std::string picture = spectrum_texture("p", "\"imagemap\" \"string filename\" \"a.png\"");
  const auto v4 = textured(
      picture + spectrum_texture("t", "\"scale\" \"texture tex\" \"p\" \"float scale\" .25"));
  EXPECT_TRUE(v4.diffuse.texture);
  EXPECT_EQ(v4.diffuse.value, Rgb(.25F, .25F, .25F));
  const auto v3 = textured(
      picture + spectrum_texture("t", "\"scale\" \"texture tex1\" \"p\" \"rgb tex2\" [.5 .25 1]"),
      true);
  EXPECT_TRUE(v3.diffuse.texture);
  EXPECT_EQ(v3.diffuse.value, Rgb(.5F, .25F, 1));
  EXPECT_EQ(v3.notes, "");
  const auto both = textured(
      picture + spectrum_texture("t", "\"scale\" \"texture tex1\" \"p\" \"texture tex2\" \"p\""),
      true);
  EXPECT_NE(both.notes.find("replaced by its mean"), std::string::npos);
}

TEST(PbrtTextures, MixturesAndConstants) {
  const std::string a = spectrum_texture("a", "\"constant\" \"rgb value\" [1 0 .5]");
  const auto mixed =
      textured(a + spectrum_texture("t",
                                    "\"mix\" \"texture tex1\" \"a\" \"rgb tex2\" [0 1 .5] "
                                    "\"float amount\" .25"));
  expect_colour(mixed.diffuse.value, {.75F, .25F, .5F});
  EXPECT_EQ(mixed.notes, "");
  const std::string picture = spectrum_texture("p", "\"imagemap\" \"string filename\" \"a.png\"");
  const auto dimmed =
      textured(picture + spectrum_texture("t",
                                          "\"mix\" \"texture tex1\" \"p\" \"rgb tex2\" [0 "
                                          "0 0] \"float amount\" .25"));
  EXPECT_TRUE(dimmed.diffuse.texture);
  expect_colour(dimmed.diffuse.value, {.75F, .75F, .75F});
}

/// pbrt's squares have a side of 1 in scaled (u, v), those of ImportedTexture 1/2.
TEST(PbrtTextures, Checkerboards) {
  const auto t =
      textured(spectrum_texture("t",
                                "\"checkerboard\" \"rgb tex1\" [.9 .8 .7] \"rgb tex2\" [.1 .2 "
                                ".3] \"float uscale\" 8 \"float vscale\" 4"));
  ASSERT_TRUE(t.diffuse.texture);
  EXPECT_TRUE(t.diffuse.texture->file.empty());
  EXPECT_EQ(t.diffuse.texture->scale, V2d(4, 2));
  expect_colour(t.diffuse.texture->even, {.9F, .8F, .7F});
  expect_colour(t.diffuse.texture->odd, {.1F, .2F, .3F});
}

TEST(PbrtTextures, OtherPatternsBecomeTheirMean) {
  const auto t =
      textured(spectrum_texture("t",
                                "\"bilerp\" \"rgb v00\" [1 1 1] \"rgb v01\" [0 0 0] \"rgb v10\" "
                                "[0 0 0] \"rgb v11\" [0 0 1]"));
  expect_colour(t.diffuse.value, {.25F, .25F, .5F});
  EXPECT_NE(t.notes.find("one value"), std::string::npos);
  EXPECT_NE(
      PbrtFolder().error("Texture \"t\" \"spectrum\" \"wood\"").find("texture \"wood\"; allowed"),
      std::string::npos);
  EXPECT_NE(PbrtFolder().error("Texture \"t\" \"int\" \"constant\"").find("allowed: float"),
            std::string::npos);
}

TEST(PbrtTextures, NamesMustBeKnown) {
  EXPECT_NE(PbrtFolder()
                .error(v4_film + "Material \"diffuse\" \"texture reflectance\" \"x\"")
                .find("\"x\""),
            std::string::npos);
  // A float texture is none of a spectrum.
  EXPECT_NE(
      PbrtFolder()
          .error(v4_film + "Texture \"x\" \"float\" \"constant\" Material \"diffuse\" \"texture "
                           "reflectance\" \"x\"")
          .find("names no spectrum texture"),
      std::string::npos);
}

TEST(PbrtTextures, MissingPicturesAreGrey) {
  const auto t = textured(spectrum_texture("t", "\"imagemap\" \"string filename\" \"none.png\""),
                          false, MissingFiles::skip);
  EXPECT_FALSE(t.diffuse.texture);
  expect_colour(t.diffuse.value, {.5F, .5F, .5F});
  EXPECT_NE(t.notes.find("does not exist"), std::string::npos);
}

TEST(PbrtTextures, BumpAndNormalMapsAndOpacity) {
  const PbrtFolder folder;
  folder.write("a.png", "");
  const auto scene = folder.import(
      v4_film +
      "WorldBegin Texture \"h\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"float "
      "scale\" .1 "
      "Texture \"o\" \"float\" \"imagemap\" \"string filename\" \"a.png\" "
      "Material \"diffuse\" \"texture displacement\" \"h\" \"string normalmap\" \"a.png\"\n" +
      "Shape \"disk\" \"texture alpha\" \"o\" Shape \"disk\" \"float alpha\" .5 Shape \"disk\" "
      "Shape \"disk\" \"texture alpha\" \"o\"");
  ASSERT_EQ(scene.shapes.size(), 4);
  const auto& m = *scene.shapes[0].material;
  EXPECT_NEAR(m.bump_scale, .1, 1e-7);
  ASSERT_TRUE(m.bump_map && m.normal_map);
  EXPECT_FALSE(m.normal_map->srgb);
  EXPECT_TRUE(m.opacity.texture);
  EXPECT_NEAR(scene.shapes[1].material->opacity.value.x, .5, 1e-6);
  EXPECT_FALSE(scene.shapes[2].material->opacity.texture);
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[3].material);
}

/// The second axis of pbrt's normal maps is n x dp/du, whatever v does.
TEST(PbrtTextures, NormalMapsOfMirroredTextureCoordinates) {
  const PbrtFolder folder;
  folder.write("a.png", "");
  const auto notes = [&](const std::string& before, const std::string& uv) {
    return noted(folder.import(
        v4_film + "WorldBegin Material \"diffuse\" \"string normalmap\" \"a.png\" " + before +
        " Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" "
        "[0 1 2] \"point2 uv\" [" +
        uv + "]"));
  };
  EXPECT_EQ(notes("", "0 0 1 0 0 1"), "");
  EXPECT_NE(notes("", "0 1 1 1 0 0"), "");
  EXPECT_EQ(notes("ReverseOrientation", "0 1 1 1 0 0"), "");
}

/// Plastic is a mixture, whose parts have the bumps.
TEST(PbrtTextures, BumpMapsOfLobes) {
  const PbrtFolder folder;
  folder.write("a.png", "");
  const auto scene =
      folder.import(v3_film +
                    "WorldBegin Texture \"h\" \"float\" \"imagemap\" \"string filename\" "
                    "\"a.png\" Material \"plastic\" \"texture bumpmap\" \"h\"\n" +
                    triangle);
  const auto& m = *scene.shapes[0].material;
  ASSERT_EQ(m.parts.size(), 2);
  EXPECT_FALSE(m.bump_map);
  for (const auto& part : m.parts) EXPECT_TRUE(part.material->bump_map);
}

/// Of a linear picture r, alpha = sqrt(r) is the picture with a gamma of 1/2.
TEST(PbrtTextures, OfRoughness) {
  const PbrtFolder folder;
  folder.write("a.png", "");
  const auto scene = folder.import(
      v4_film +
      "WorldBegin Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"string "
      "encoding\" "
      "\"linear\" \"float scale\" .25 Material \"dielectric\" \"texture roughness\" \"r\"\n" +
      triangle);
  const auto& m = *scene.shapes[0].material;
  ASSERT_TRUE(m.alpha_texture);
  EXPECT_EQ(m.alpha_texture->gamma, .5);
  EXPECT_NEAR(m.alpha[0], .5, 1e-6);
  EXPECT_EQ(noted(scene), "");
}

}  // namespace
}  // namespace lacuna
