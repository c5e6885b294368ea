#include "jobs/import/pbrt/pbrt_materials.h"

#include <functional>
#include <numbers>

#include "jobs/import/spectrum.h"
#include "tests/jobs/import/pbrt/pbrt_fixture.h"

namespace lacuna {
namespace {

using MaterialType = ImportedMaterial::Type;

struct MaterialOf {
  std::shared_ptr<const ImportedMaterial> material;
  std::string notes;
  const ImportedMaterial* operator->() const { return material.get(); }
};

/// The material of a triangle after `statements`.
MaterialOf material_after(const std::string& statements, const std::string& film = v4_film) {
  const auto scene = PbrtFolder().import(film + "WorldBegin " + statements + "\n" + triangle);
  EXPECT_EQ(scene.shapes.size(), 1);
  return {scene.shapes.at(0).material, noted(scene)};
}
MaterialOf v4_material(const std::string& m) { return material_after("Material " + m); }
MaterialOf v3_material(const std::string& m) { return material_after("Material " + m, v3_film); }

TEST(PbrtMaterials, DefaultsAreDiffuse) {
  const auto m = material_after("");
  EXPECT_EQ(m->type, MaterialType::diffuse);
  expect_colour(m->diffuse.value, {.5F, .5F, .5F});
  EXPECT_EQ(m.notes, "");
  EXPECT_FALSE(m->one_sided);
}

TEST(PbrtMaterials, Diffuse) {
  const auto m = v4_material("\"diffuse\" \"rgb reflectance\" [.1 .2 .3]");
  expect_colour(m->diffuse.value, {.1F, .2F, .3F});
  EXPECT_EQ(m.notes, "");
  const auto rough = v3_material("\"matte\" \"color Kd\" [.1 .2 .3] \"float sigma\" 90");
  expect_colour(rough->diffuse.value, {.1F, .2F, .3F});
  EXPECT_NEAR(rough->sigma, std::numbers::pi / 2, 1e-9);
}

TEST(PbrtMaterials, RoughnessIsMapped) {
  EXPECT_NEAR(v4_material("\"conductor\" \"float roughness\" .25")->alpha[0], .5, 1e-6);
  EXPECT_TRUE(v4_material("\"conductor\" \"float roughness\" .25")->correlated_masking);
  const auto plain = v4_material(
      "\"conductor\" \"float uroughness\" .2 \"float vroughness\" .3 \"bool remaproughness\" "
      "false");
  EXPECT_NEAR(plain->alpha[0], .2, 1e-6);
  EXPECT_NEAR(plain->alpha[1], .3, 1e-6);
  EXPECT_EQ(v4_material("\"conductor\"")->alpha[0], 0);
  // ln(.1) in pbrt-v3's polynomial: 1.62142 - 1.88802 + .91934 - .20901 + .01801.
  EXPECT_NEAR(v3_material("\"metal\" \"float roughness\" .1")->alpha[0], .46174, 1e-4);
  EXPECT_NEAR(
      v3_material("\"metal\" \"float roughness\" .3 \"bool remaproughness\" \"false\"")->alpha[1],
      .3, 1e-6);
  const auto wide = v3_material("\"metal\" \"float roughness\" 1");
  EXPECT_EQ(wide->alpha[0], 1);
  EXPECT_NE(wide.notes.find("limited to 1"), std::string::npos);
  EXPECT_NE(PbrtFolder()
                .error(v4_film + "Material \"conductor\" \"float roughness\" -1")
                .find("roughness -1"),
            std::string::npos);
}

TEST(PbrtMaterials, ConductorsHaveComplexIndices) {
  const auto gold =
      v4_material("\"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"");
  EXPECT_EQ(gold->type, MaterialType::conductor);
  expect_colour(gold->eta, metal_index("Au")->eta);
  expect_colour(gold->k, metal_index("Au")->k);
  expect_colour(v4_material("\"conductor\"")->k, metal_index("Cu")->k);
  const auto rgb = v3_material("\"metal\" \"rgb eta\" [.2 .9 1.1] \"rgb k\" [3.9 2.4 2.2]");
  expect_colour(rgb->eta, {.2F, .9F, 1.1F});
  EXPECT_EQ(rgb.notes, "");
  EXPECT_NE(PbrtFolder()
                .error(v4_film + "Material \"conductor\" \"spectrum eta\" \"metal-Xx-eta\"")
                .find("no named spectrum"),
            std::string::npos);
}

/// R = ((1 - eta)^2 + k^2) / ((1 + eta)^2 + k^2).
TEST(PbrtMaterials, ConductorsOfAReflectance) {
  const auto m = v4_material("\"conductor\" \"rgb reflectance\" [.1 .5 1]");
  const std::array<double, 3> reflectance{.1, .5, .9999};
  for (int c = 0; c < 3; ++c) {
    const double k2 = std::pow(double(m->k[c]), 2);
    EXPECT_NEAR(k2 / (4 + k2), reflectance[static_cast<std::size_t>(c)], 1e-4);
    EXPECT_EQ(m->eta[c], 1);
  }
  const auto mirror = v3_material("\"mirror\"");
  expect_colour(mirror->reflectance.value, {.9F, .9F, .9F});
  expect_colour(mirror->eta, {0, 0, 0});
  EXPECT_EQ(mirror->alpha[0], 0);
}

TEST(PbrtMaterials, SpectraMayLieInFiles) {
  const PbrtFolder folder;
  folder.write("spds/x.eta.spd", "# wavelength value\n400 2 500 2\n600 2.0 # end\n800 2\n");
  const auto scene =
      folder.import(v3_film +
                    "WorldBegin Material \"metal\" \"spectrum eta\" \"spds/x.eta.spd\" "
                    "\"spectrum k\" [300 1 900 1]" +
                    triangle);
  expect_colour(scene.shapes[0].material->eta,
                rgb_of_spectrum({{400, 2}, {800, 2}}, EqualEnergy::coloured));
  expect_colour(scene.shapes[0].material->k,
                rgb_of_spectrum({{300, 1}, {900, 1}}, EqualEnergy::coloured));
  folder.write("spds/x.eta.spd", "400 2 300 1");
  const auto error = [&](const std::string& file) {
    return folder.error(v3_film + "Material \"metal\" \"spectrum eta\" \"" + file + "\"");
  };
  EXPECT_NE(error("spds/x.eta.spd").find("wavelength 300 after 400"), std::string::npos);
  EXPECT_NE(error("none.spd").find("nor a file"), std::string::npos);
  EXPECT_NE(error("../none.spd").find("within the folder"), std::string::npos);
}

TEST(PbrtMaterials, Dielectrics) {
  const auto glass = v4_material("\"dielectric\" \"float eta\" 1.33 \"float roughness\" .04");
  EXPECT_EQ(glass->type, MaterialType::dielectric);
  EXPECT_NEAR(glass->ior, 1.33, 1e-9);
  EXPECT_NEAR(glass->alpha[0], .2, 1e-6);
  const auto named = v4_material("\"dielectric\" \"spectrum eta\" \"glass-BK7\"");
  EXPECT_NEAR(named->ior, 1.5168, 1e-6);
  EXPECT_NE(named.notes.find("no dispersion"), std::string::npos);
  const auto cauchy = v4_material("\"dielectric\" \"spectrum eta\" [489 1.6 689 1.4]");
  EXPECT_NEAR(cauchy->ior, 1.5, 1e-6);
  EXPECT_EQ(v4_material("\"thindielectric\"")->type, MaterialType::thin_dielectric);
  const auto old = v3_material("\"glass\" \"float index\" 1.4 \"rgb Kt\" [.5 1 1]");
  EXPECT_NEAR(old->ior, 1.4, 1e-9);
  expect_colour(old->transmittance.value, {.5F, 1, 1});
  EXPECT_EQ(old->alpha[0], 0);  // smooth, though pbrt-v3 would map 0 to .047
  EXPECT_GT(v3_material("\"glass\" \"float uroughness\" .1")->alpha[0], .4);
}

TEST(PbrtMaterials, CoatedOnes) {
  const auto plastic =
      v4_material("\"coateddiffuse\" \"rgb reflectance\" [.4 .4 .4] \"float thickness\" 0");
  EXPECT_EQ(plastic->type, MaterialType::plastic);
  EXPECT_TRUE(plastic->nonlinear);
  expect_colour(plastic->diffuse.value, {.4F, .4F, .4F});
  const auto metal = v4_material(
      "\"coatedconductor\" \"float interface.eta\" 2 \"rgb conductor.eta\" [1 2 3] \"rgb "
      "conductor.k\" "
      "[4 4 4] \"float conductor.roughness\" .25 \"float interface.roughness\" .01 \"float "
      "thickness\" .5");
  EXPECT_EQ(metal->type, MaterialType::coating);
  EXPECT_NEAR(metal->alpha[0], .1, 1e-6);
  EXPECT_NEAR(metal->thickness, .5, 1e-6);
  ASSERT_EQ(metal->parts.size(), 1);
  expect_colour(metal->parts[0].material->eta, {.5F, 1, 1.5F});
  EXPECT_NEAR(metal->parts[0].material->alpha[0], .5, 1e-6);
}

/// Lobes of a mixture, each times its weight.
Rgb sum_of(const ImportedMaterial& m, const std::function<Rgb(const ImportedMaterial&)>& of) {
  Rgb sum(0, 0, 0);
  for (const auto& part : m.parts) sum += part.weight * of(*part.material);
  return sum;
}

TEST(PbrtMaterials, PlasticIsASumOfTwoLobes) {
  const auto m = v3_material("\"plastic\" \"rgb Kd\" [.5 .3 .1] \"rgb Ks\" [.2 .2 .2]");
  ASSERT_EQ(m->type, MaterialType::mixture);
  EXPECT_EQ(m.notes, "");
  expect_colour(sum_of(*m.material,
                       [](const ImportedMaterial& p) {
                         return p.type == MaterialType::diffuse ? p.diffuse.value : Rgb(0, 0, 0);
                       }),
                {.5F, .3F, .1F});
  expect_colour(sum_of(*m.material,
                       [](const ImportedMaterial& p) {
                         return p.type == MaterialType::conductor ? p.reflectance.value
                                                                  : Rgb(0, 0, 0);
                       }),
                {.2F, .2F, .2F});
  const auto bright = v3_material("\"plastic\" \"rgb Kd\" [.9 .3 .1] \"rgb Ks\" [.2 .2 .2]");
  EXPECT_EQ(bright->type, MaterialType::standard);
  EXPECT_NE(bright.notes, "");
  EXPECT_EQ(v3_material("\"uber\" \"rgb Ks\" [0 0 0]")->type, MaterialType::diffuse);
  EXPECT_NEAR(v3_material("\"uber\" \"rgb opacity\" [.25 .25 .25]")->opacity.value.x, .25, 1e-6);
}

TEST(PbrtMaterials, LightPassesThroughSome) {
  const auto m = v4_material(
      "\"diffusetransmission\" \"rgb reflectance\" [.3 .2 .1] \"rgb transmittance\" "
      "[.1 .2 .4]");
  expect_colour(sum_of(*m.material,
                       [](const ImportedMaterial& p) {
                         return p.type == MaterialType::diffuse ? p.diffuse.value : Rgb(0, 0, 0);
                       }),
                {.3F, .2F, .1F});
  expect_colour(sum_of(*m.material,
                       [](const ImportedMaterial& p) {
                         return p.type == MaterialType::diffuse_transmission ? p.transmittance.value
                                                                             : Rgb(0, 0, 0);
                       }),
                {.1F, .2F, .4F});
  EXPECT_EQ(m.notes, "");
  EXPECT_EQ(v3_material("\"translucent\"")->type, MaterialType::mixture);
}

TEST(PbrtMaterials, MixesWeighTheSecondOrTheFirst) {
  const std::string two = "MakeNamedMaterial \"a\" \"string type\" \"";
  const auto v4 =
      material_after(two +
                     "diffuse\" MakeNamedMaterial \"b\" \"string type\" \"conductor\" "
                     "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .2");
  ASSERT_EQ(v4->parts.size(), 2);
  EXPECT_EQ(v4->parts[1].material->type, MaterialType::conductor);
  expect_colour(v4->parts[1].weight, {.2F, .2F, .2F});
  expect_colour(v4->parts[0].weight, {.8F, .8F, .8F});
  const auto v3 =
      material_after(two +
                         "matte\" MakeNamedMaterial \"b\" \"string type\" \"metal\" Material "
                         "\"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" "
                         "\"b\" \"rgb amount\" [.2 .3 .4]",
                     v3_film);
  expect_colour(v3->parts[0].weight, {.2F, .3F, .4F});
  expect_colour(v3->parts[1].weight, {.8F, .7F, .6F});
}

TEST(PbrtMaterials, NamesMayComeBeforeTheirDefinition) {
  const PbrtFolder folder;
  const auto scene = folder.import(v4_film + "WorldBegin NamedMaterial \"later\" " + triangle +
                                   "MakeNamedMaterial \"later\" \"string type\" \"conductor\"");
  EXPECT_EQ(scene.shapes[0].material->type, MaterialType::conductor);
  EXPECT_EQ(scene.shapes[0].material->name, "later");
  EXPECT_EQ(folder.error(v4_film + "\nNamedMaterial \"x\""),
            "scene.pbrt:3: material \"x\" is not defined");
  EXPECT_NE(folder.error("Material \"chrome\"").find("material \"chrome\"; allowed"),
            std::string::npos);
}

TEST(PbrtMaterials, NamesOfV3EndWithTheirScope) {
  const std::string text =
      "WorldBegin MakeNamedMaterial \"m\" \"string type\" \"mirror\" AttributeBegin "
      "MakeNamedMaterial "
      "\"m\" \"string type\" \"metal\" AttributeEnd NamedMaterial \"m\" " +
      triangle;
  expect_colour(PbrtFolder().import(v3_film + text).shapes[0].material->eta, {0, 0, 0});
  EXPECT_GT(PbrtFolder().import(v4_film + text).shapes[0].material->eta.x, 0);
}

TEST(PbrtMaterials, InterfacesAreInvisible) {
  const auto scene = PbrtFolder().import(v4_film + "WorldBegin Material \"interface\" " + triangle +
                                         "Material \"diffuse\" " + triangle);
  EXPECT_EQ(scene.shapes.size(), 1);
  EXPECT_TRUE(
      PbrtFolder().import(v3_film + "WorldBegin Material \"none\" " + triangle).shapes.empty());
}

TEST(PbrtMaterials, OtherModelsAreNoted) {
  for (const std::string type : {"hair", "measured"}) {
    EXPECT_NE(v4_material("\"" + type + "\"").notes.find("stands for it"), std::string::npos);
  }
  EXPECT_NE(v4_material("\"subsurface\"").notes.find("below the surface"), std::string::npos);
  EXPECT_NE(v3_material("\"disney\"").notes.find("nearest"), std::string::npos);
  EXPECT_NE(v3_material("\"substrate\"").notes.find("glTF's own"), std::string::npos);
}

TEST(PbrtMaterials, TheVersionIsThatOfTheFirstStatementThatTells) {
  const auto alpha = [](const std::string& before, const std::string& type) {
    return PbrtFolder()
        .import(before + "WorldBegin MakeNamedMaterial \"m\" \"string type\" \"" + type +
                "\" \"float roughness\" .1 NamedMaterial \"m\" " + triangle)
        .shapes[0]
        .material->alpha[0];
  };
  EXPECT_NEAR(alpha("", "metal"), .46174, 1e-4);
  EXPECT_NEAR(alpha("", "conductor"), std::sqrt(.1), 1e-6);
  EXPECT_NEAR(alpha("Option \"bool x\" true ", "metal"), std::sqrt(.1), 1e-6);
  // "color" as a type of textures, not as a name.
  EXPECT_NEAR(alpha("Texture \"c\" \"color\" \"constant\" ", "conductor"), .46174, 1e-4);
  EXPECT_NEAR(alpha("Texture \"color\" \"spectrum\" \"constant\" ", "conductor"), std::sqrt(.1),
              1e-6);
  EXPECT_NE(noted(PbrtFolder().import("WorldBegin")).find("no statement of it shows"),
            std::string::npos);
  EXPECT_EQ(noted(PbrtFolder().import("WorldBegin WorldEnd")), "");
  const PbrtFolder folder;
  folder.write("film.pbrt", v3_film);
  EXPECT_EQ(noted(folder.import("Include \"film.pbrt\" WorldBegin")), "");
}

/// glTF's roughness is the square root of alpha, which is a power of pbrt's roughness.
TEST(PbrtMaterials, TexturesOfRoughnessAreThoseOfGltfsOwnMaterial) {
  const PbrtFolder folder;
  folder.write("r.png", "");
  const auto scene = folder.import(
      v3_film +
          "WorldBegin Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"r.png\" \"bool "
          "gamma\" \"false\" Material \"substrate\" \"texture uroughness\" \"r\" \"texture "
          "vroughness\" \"r\" \"bool remaproughness\" \"false\" " +
          triangle,
      MissingFiles::refuse);
  const ImportedMaterial& m = *scene.shapes.at(0).material;
  ASSERT_NE(m.roughness_texture, nullptr);
  EXPECT_EQ(m.roughness_texture->gamma, .5);
  EXPECT_EQ(m.roughness, 1);
  EXPECT_EQ(m.alpha_texture, nullptr);
}

TEST(PbrtMaterials, LobesOfAMixtureHaveItsName) {
  const auto m = v3_material("\"plastic\" \"rgb Kd\" [.5 .5 .5] \"rgb Ks\" [.2 .2 .2]");
  ASSERT_EQ(m->parts.size(), 2);
  EXPECT_EQ(m->parts[1].material->name, "plastic");
  EXPECT_NE(m->parts[1].material->place.find("scene.pbrt:"), std::string::npos);
}

TEST(PbrtMaterials, DielectricsAbsorbAsTheirMedium) {
  const PbrtFolder folder;
  const auto with = [&](const std::string& medium, const std::string& rest) {
    return folder.import(v4_film + "WorldBegin MakeNamedMedium \"m\" \"string type\" " + medium +
                         " AttributeBegin " + rest + " AttributeEnd Material \"dielectric\" " +
                         triangle);
  };
  const std::string wine =
      "\"homogeneous\" \"rgb sigma_a\" [0 1 2] \"rgb sigma_s\" [0 0 0] \"float scale\" 3";
  const std::string glass =
      "MediumInterface \"m\" \"\" Material \"dielectric\" " + triangle + triangle;
  const auto scene = with(wine, glass);
  ASSERT_EQ(scene.shapes.size(), 3);
  EXPECT_EQ(scene.shapes[0].material->absorption, Rgb(0, 3, 6));
  EXPECT_EQ(scene.shapes[0].material, scene.shapes[1].material);
  EXPECT_EQ(scene.shapes[2].material->absorption, Rgb(0, 0, 0)) << "the attribute has ended";
  EXPECT_EQ(noted(scene), "");
  EXPECT_EQ(with("\"homogeneous\" \"rgb sigma_a\" [1 -1 0]", glass).shapes[0].material->absorption,
            Rgb(1, 0, 0));
  EXPECT_NE(noted(with("\"homogeneous\"", glass)).find("not what it scatters"), std::string::npos);
  EXPECT_NE(noted(with("\"nanovdb\" \"string filename\" \"a\"", glass)).find("homogeneous ones"),
            std::string::npos);
  for (const char* other : {"interface", "diffuse"}) {
    EXPECT_NE(noted(with(wine, "MediumInterface \"m\" \"\" Material \"" + std::string(other) +
                                   "\" " + triangle))
                  .find("medium \"m\": a medium within what is no dielectric"),
              std::string::npos)
        << other;
  }
  EXPECT_NE(noted(with(wine, "MediumInterface \"x\" \"\"")).find("no medium \"x\""),
            std::string::npos);
  EXPECT_NE(noted(with(wine, "MediumInterface \"\" \"m\"")).find("medium outside"),
            std::string::npos);
}

}  // namespace
}  // namespace lacuna
