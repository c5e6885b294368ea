#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/json/json_text.h"
#include "jobs/import/mitsuba/read_mitsuba.h"
#include "jobs/import/scene_write.h"
#include "renderer/core/scene_error.h"
#include "renderer/images/png_write.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

ImportedScene with_bsdf(const std::string& bsdf) {
  return read_mitsuba_text(
      "<scene version='0.6.0'><sensor type='orthographic'/>\n<shape "
      "type='rectangle'>" +
      bsdf + "</shape></scene>");
}

ImportedMaterial material_of(const std::string& bsdf) {
  return *with_bsdf(bsdf).shapes.at(0).material;
}

using MaterialType = ImportedMaterial::Type;

TEST(MitsubaMaterials, OneSidedUnlessTwosided) {
  const std::string diffuse =
      "<bsdf type='diffuse'><srgb name='reflectance' value='#80ff00'/></bsdf>";
  const ImportedMaterial front = material_of(diffuse);
  EXPECT_TRUE(front.one_sided);
  EXPECT_NEAR(front.diffuse.value.x, .2158605F, 1e-6);
  EXPECT_FALSE(material_of("<bsdf type='twosided'>" + diffuse + "</bsdf>").one_sided);
  EXPECT_FALSE(material_of("<bsdf type='dielectric'/>").one_sided);
  const ImportedMaterial both = material_of(
      "<bsdf type='twosided'><bsdf type='blendbsdf'><float name='weight' value='.25'/>" + diffuse +
      "<bsdf type='conductor'/></bsdf></bsdf>");
  ASSERT_EQ(both.parts.size(), 2U);
  EXPECT_FALSE(both.parts[0].material->one_sided);
  EXPECT_EQ(both.parts[0].weight, Rgb(.75F));
  EXPECT_EQ(both.parts[1].weight, Rgb(.25F));
}

TEST(MitsubaMaterials, ConductorsByNameAndByIndex) {
  const ImportedMaterial copper = material_of("<bsdf type='conductor'/>");
  EXPECT_EQ(copper.type, MaterialType::conductor);
  EXPECT_NEAR(copper.eta.x, .200436 / 1.000277, 1e-6);
  EXPECT_NEAR(copper.k.z, 2.142188 / 1.000277, 1e-6);
  const ImportedMaterial own = material_of(
      "<bsdf type='roughconductor'><rgb name='eta' value='1 2 3'/><rgb name='k' value='4 5 6'/>"
      "<float name='extEta' value='2'/><string name='distribution' value='ggx'/><float "
      "name='alphaU' value='.2'/><float name='alphaV' value='.4'/></bsdf>");
  EXPECT_EQ(own.eta, Rgb(.5F, 1, 1.5F));
  EXPECT_EQ(own.k, Rgb(2, 2.5F, 3));
  EXPECT_FALSE(own.beckmann);
  EXPECT_NEAR(own.alpha[0], .2, 1e-7);
  EXPECT_NEAR(own.alpha[1], .4, 1e-7);
  EXPECT_TRUE(material_of("<bsdf type='roughconductor'/>").beckmann);
  EXPECT_TRUE(contains(message_of<SceneError>([&] {
                         material_of(
                             "<bsdf type='conductor'><string name='material' "
                             "value='Kryptonite'/></bsdf>");
                       }),
                       "has the material \"Kryptonite\", which is not known"));
}

TEST(MitsubaMaterials, IndicesOfRefractionAreRelative) {
  EXPECT_NEAR(material_of("<bsdf type='dielectric'/>").ior, 1.5046 / 1.000277, 1e-9);
  EXPECT_NEAR(material_of("<bsdf type='plastic'/>").ior, 1.49 / 1.000277, 1e-9);
  EXPECT_NEAR(material_of("<bsdf type='thindielectric'><string name='intIOR' value='water'/><float "
                          "name='extIOR' value='1'/></bsdf>")
                  .ior,
              1.333, 1e-9);
  // The names of Mitsuba 3.
  EXPECT_NEAR(material_of("<bsdf type='roughdielectric'><float name='int_ior' value='1.2'/><string "
                          "name='ext_ior' value='vacuum'/></bsdf>")
                  .ior,
              1.2, 1e-6);
}

TEST(MitsubaMaterials, WrappersCarryWhatTheyWrap) {
  const ImportedMaterial mask = material_of(
      "<bsdf type='mask'><float name='opacity' value='.25'/><bsdf type='roughdiffuse'><float "
      "name='alpha' value='.3'/></bsdf></bsdf>");
  EXPECT_EQ(mask.opacity.value, Rgb(.25F));
  EXPECT_NEAR(mask.sigma, .3 / std::numbers::sqrt2, 1e-7);
  const ImportedMaterial bump = material_of(
      "<bsdf type='bumpmap'><texture type='scale'><float name='scale' value='.15'/><texture "
      "type='checkerboard'/></texture><bsdf type='phong'><float name='exponent' "
      "value='7'/></bsdf></bsdf>");
  EXPECT_EQ(bump.type, MaterialType::phong);
  EXPECT_EQ(bump.exponent, 7);
  ASSERT_TRUE(bump.bump_map);
  EXPECT_NEAR(bump.bump_scale, .15, 1e-6);
  const ImportedMaterial coat = material_of(
      "<bsdf type='roughcoating'><float name='thickness' value='2'/><rgb name='sigmaA' value='1 2 "
      "3'/><bsdf type='ward'><string name='variant' value='ward-duer'/></bsdf></bsdf>");
  EXPECT_EQ(coat.type, MaterialType::coating);
  EXPECT_EQ(coat.thickness, 2);
  EXPECT_EQ(coat.absorption, Rgb(1, 2, 3));
  EXPECT_EQ(coat.parts.at(0).material->ward_variant, "duer");
  EXPECT_EQ(material_of("<bsdf type='null'/>").opacity.value, Rgb(0));
}

TEST(MitsubaMaterials, TexturesArePlacedWithRowZeroAtVZero) {
  const ImportedMaterial m = material_of(
      "<bsdf type='diffuse'><texture type='checkerboard' name='reflectance'><float name='uscale' "
      "value='3'/><float name='vscale' value='2'/><float name='voffset' value='.25'/><rgb "
      "name='color0' value='1'/><rgb name='color1' value='0'/></texture></bsdf>");
  ASSERT_TRUE(m.diffuse.texture);
  const ImportedTexture& t = *m.diffuse.texture;
  // Mitsuba's v of the picture at its own v = .1, which is .9 upwards.
  const double theirs = 2 * .1 + .25, ours = t.scale.y * .9 + t.offset.y;
  EXPECT_NEAR(1 - theirs, ours, 1e-12);
  // Its cell at u = v = 0 has color0; upwards that is the upper left one, which is odd.
  EXPECT_EQ(t.odd, Rgb(1));
  EXPECT_EQ(t.even, Rgb(0));
}

TEST(MitsubaMaterials, MediumInsideOfGlassAbsorbs) {
  const ImportedScene scene = with_bsdf(
      "<bsdf type='dielectric'/><medium type='homogeneous' name='interior'><rgb name='sigmaA' "
      "value='1 2 3'/><float name='scale' value='.5'/></medium>");
  EXPECT_EQ(scene.shapes.at(0).material->absorption, Rgb(.5F, 1, 1.5F));
  EXPECT_TRUE(scene.notes.empty());
}

/// The members of the extension, of the material of a square.
Json exact_of(const std::string& bsdf) {
  const TemporaryFolder folder;
  write_imported_scene(with_bsdf(bsdf), folder / "s");
  const std::string glb = content_of(folder / "s/scene.glb");
  constexpr std::size_t json_at = 20;
  const auto length = *reinterpret_cast<const std::uint32_t*>(glb.data() + 12);
  const Json json = parse_own_sorted(glb.substr(json_at, length));
  const Json& mesh = json["meshes"][0]["primitives"][0];
  return json["materials"][mesh["material"].get<std::size_t>()].value("extensions", Json::object());
}

TEST(MitsubaMaterials, ExtensionIsWrittenWhereGltfIsNotExact) {
  EXPECT_FALSE(
      exact_of("<bsdf type='twosided'><bsdf type='diffuse'/></bsdf>").contains("LACUNA_materials"));
  EXPECT_FALSE(exact_of("<bsdf type='dielectric'/>").contains("LACUNA_materials"));
  EXPECT_EQ(exact_of("<bsdf type='diffuse'/>")["LACUNA_materials"],
            Json({{"type", "diffuse"}, {"oneSided", true}}));
  EXPECT_EQ(exact_of("<bsdf type='roughplastic'><float name='intIOR' value='1.5'/><float "
                     "name='extIOR' value='1'/><float name='alpha' value='.25'/><boolean "
                     "name='nonlinear' value='true'/></bsdf>")["LACUNA_materials"],
            Json({{"type", "plastic"},
                  {"oneSided", true},
                  {"ior", 1.5},
                  {"distribution", "beckmann"},
                  {"alpha", .25},
                  {"nonlinear", true}}));
  const Json mixture = exact_of(
      "<bsdf type='mixturebsdf'><string name='weights' value='.5, .25'/><bsdf "
      "type='diffuse'/><bsdf "
      "type='thindielectric'/></bsdf>");
  EXPECT_EQ(
      mixture["LACUNA_materials"],
      Json({{"type", "mixture"},
            {"parts", {{{"material", 0}, {"weight", .5}}, {{"material", 1}, {"weight", .25}}}}}));
}

TEST(MitsubaMaterials, OthersHaveStandIns) {
  const ImportedScene radio = with_bsdf(
      "<bsdf type='itu-radio-material' id='wall'><string name='type' value='concrete'/>"
      "<rgb name='color' value='.5 .4 .3'/></bsdf>");
  EXPECT_EQ(radio.shapes[0].material->diffuse.value, Rgb(.5F, .4F, .3F));
  ASSERT_EQ(radio.notes.size(), 1U);
  EXPECT_EQ(radio.notes[0].name, "bsdf \"wall\" (itu-radio-material)");
  EXPECT_EQ(radio.notes[0].treatment, "approximated");
  EXPECT_EQ(material_of("<bsdf type='hk'/>").diffuse.value, Rgb(.5F));
  EXPECT_EQ(material_of("<bsdf type='mine'><bsdf type='plastic'/></bsdf>").type,
            MaterialType::plastic);
  EXPECT_EQ(material_of("<bsdf type='polarizer'/>").opacity.value, Rgb(0)) << "light passes";
  const ImportedMaterial pattern = material_of(
      "<bsdf type='diffuse'><texture name='reflectance' type='gridtexture'><rgb "
      "name='color0' value='.2'/><rgb name='color1' value='.6'/></texture></bsdf>");
  EXPECT_NEAR(pattern.diffuse.value.x, .4, 1e-6);
}

TEST(MitsubaMaterials, PrincipledWithTextures) {
  const TemporaryFolder folder;
  folder.write("r.png", encode_png(1, 1, std::vector<std::uint8_t>{128, 128, 128}));
  const auto texture = [](const std::string& name) {
    return "<texture type='bitmap' name='" + name +
           "'><string name='filename' value='r.png'/><boolean name='raw' value='true'/></texture>";
  };
  const auto file =
      folder.write("scene.xml",
                   "<scene version='3.0.0'><sensor type='orthographic'/><shape type='cube'><bsdf "
                   "type='principled'>" +
                       texture("roughness") + texture("metallic") + texture("clearcoat") +
                       "<float name='spec_tint' value='0'/></bsdf></shape></scene>");
  const ImportedScene scene = read_mitsuba(file, MissingFiles::refuse);
  const ImportedMaterial& m = *scene.shapes.at(0).material;
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(m.roughness_texture->file.filename(), "r.png");
  EXPECT_EQ(m.metallic_texture->file.filename(), "r.png");
  EXPECT_EQ(m.coat, .5);
  ASSERT_EQ(scene.notes.size(), 2U);
  EXPECT_EQ(scene.notes[0].how, "0.5 stands for the texture of its clearcoat");
}

TEST(MitsubaMaterials, CoatsLieOverOpaqueBsdfsOnly) {
  for (const char* base : {"<bsdf type='dielectric'/>",
                           "<bsdf type='coating'><bsdf "
                           "type='diffuse'/></bsdf>"}) {
    const ImportedScene scene = with_bsdf("<bsdf type='coating'>" + std::string(base) + "</bsdf>");
    EXPECT_NE(scene.shapes[0].material->parts.empty(), false || base[12] == 'c') << base;
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_EQ(scene.notes[0].treatment, "left out");
  }
}

TEST(MitsubaMaterials, SpectraThatWrapAColour) {
  const ImportedMaterial m = material_of(
      "<bsdf type='diffuse'><spectrum type='srgb' name='reflectance'><rgb name='color' value='.2 "
      ".3 .4'/></spectrum></bsdf>");
  EXPECT_EQ(m.diffuse.value, Rgb(.2F, .3F, .4F));
}

}  // namespace
}  // namespace lacuna
