#include "jobs/import/pbrt/pbrt_lights.h"

#include <numbers>

#include "jobs/import/equal_area.h"
#include "jobs/import/spectrum.h"
#include "tests/jobs/import/pbrt/pbrt_fixture.h"

namespace lacuna {
namespace {

/// A world with these statements that is not mirrored.
ImportedScene lit(const std::string& statements, const std::string& film = v4_film) {
  PbrtFolder folder;
  folder.write("sky.exr", "");
  return folder.import(film + "Scale -1 1 1 Camera \"perspective\" WorldBegin " + statements);
}
ImportedLight light_of(const std::string& statements, const std::string& film = v4_film) {
  return lit("LightSource " + statements, film).lights.at(0);
}

TEST(PbrtLights, PointLights) {
  const auto scene =
      lit("Translate 1 2 3 LightSource \"point\" \"rgb I\" [1 2 3] \"float scale\" 2 \"point3 "
          "from\" [0 0 1]");
  expect_near(scene.lights.at(0).position, V3d(1, 2, 4));
  expect_colour(scene.lights[0].intensity, {2, 4, 6});
  EXPECT_EQ(scene.notes.size(), 0);
  expect_colour(light_of("\"point\" \"float power\" 100").intensity,
                Rgb(1, 1, 1) * static_cast<float>(100 / (4 * std::numbers::pi)));
  expect_colour(light_of("\"point\" \"rgb I\" [1 2 3] \"rgb scale\" [2 1 1]", v3_film).intensity,
                {2, 2, 3});
}

TEST(PbrtLights, DistantLights) {
  const auto light =
      light_of("\"distant\" \"point3 from\" [0 5 0] \"point3 to\" [0 0 0] \"float illuminance\" 3");
  EXPECT_EQ(light.kind, ImportedLight::Kind::directional);
  expect_near(light.direction, V3d(0, -1, 0));
  expect_colour(light.intensity, {3, 3, 3});
  const auto turned = lit("Rotate 90 1 0 0 LightSource \"distant\"").lights.at(0);
  expect_near(turned.direction, V3d(0, -1, 0));  // +z, turned
}

/// Flux between the cones: the mean of the file's ramp is that of glTF's.
TEST(PbrtLights, SpotLightsKeepTheirFlux) {
  for (const bool v3 : {false, true}) {
    const auto s = light_of(
        "\"spot\" \"rgb I\" [2 2 2] \"float coneangle\" 40 \"float conedeltaangle\" 10 "
        "\"point3 to\" [0 0 -3]",
        v3 ? v3_film : v4_film);
    expect_near(s.direction, V3d(0, 0, -1));
    EXPECT_NEAR(s.outer_cone, 40 * std::numbers::pi / 180, 1e-9);
    const double end = std::cos(40 * std::numbers::pi / 180),
                 start = std::cos(30 * std::numbers::pi / 180);
    double flux = 0, gltf = 0;
    constexpr int steps = 10000;
    for (int i = 0; i < steps; ++i) {
      const double c = end + (1 - end) * (i + .5) / steps;
      const double t = std::clamp((c - end) / (start - end), 0.0, 1.0);
      flux += v3 ? t * t * t * t : t * t * (3 - 2 * t);
      const double u = std::clamp((c - end) / (std::cos(s.inner_cone) - end), 0.0, 1.0);
      gltf += u * u;
    }
    EXPECT_NEAR(gltf / flux, 1, 1e-4);
  }
}

TEST(PbrtLights, SpectraOfV4HaveALuminanceOfOne) {
  const Rgb black = light_of("\"point\" \"blackbody I\" 3000").intensity;
  EXPECT_NEAR(luminance(black), 1, 1e-5);
  const Rgb expected = blackbody_rgb(3000);
  expect_colour(black, expected / luminance(expected), 1e-4);
  EXPECT_NEAR(luminance(light_of("\"point\" \"spectrum I\" [400 7 700 9]").intensity), 1, 1e-5);
  EXPECT_NEAR(luminance(light_of("\"point\" \"spectrum I\" \"stdillum-A\"").intensity), 1, 1e-4);
  expect_colour(light_of("\"point\" \"spectrum I\" \"stdillum-D65\"").intensity, {1, 1, 1}, 2e-3);
}

/// A black body of pbrt-v3 has a peak of 1 in its spectrum, times the second number.
TEST(PbrtLights, BlackBodiesOfV3HaveAPeakOfOne) {
  const Rgb c = light_of("\"point\" \"blackbody I\" [5000 3]", v3_film).intensity;
  Spectrum planck;
  for (int nm = 350; nm <= 840; ++nm) {
    const double x = 1.438776877e7 / (nm * 5000.0);  // c2 in nm K
    const double peak = std::pow(4.965114231744276, 5) / std::expm1(4.965114231744276);
    planck.emplace_back(nm, 3 * std::pow(x, 5) / std::expm1(x) / peak);
  }
  const Rgb expected = rgb_of_spectrum(planck, EqualEnergy::coloured);
  expect_colour(c, expected, 2e-3);
  expect_colour(light_of("\"point\" \"spectrum I\" [300 2 900 2]", v3_film).intensity,
                rgb_of_spectrum({{300, 2}, {900, 2}}, EqualEnergy::coloured), 1e-4);
}

TEST(PbrtLights, ColourSpaces) {
  const auto scene =
      lit("ColorSpace \"rec2020\" LightSource \"point\" \"rgb I\" [1 1 1] "
          "LightSource \"point\" \"rgb I\" [0 1 0]");
  expect_colour(scene.lights.at(0).intensity, {1, 1, 1}, 2e-3);
  EXPECT_GT(scene.lights.at(1).intensity.y, 1.1F);  // and red, blue are cut at 0
  EXPECT_NE(PbrtFolder().error("ColorSpace \"x\"").find("ColorSpace \"x\"; allowed"),
            std::string::npos);
}

TEST(PbrtLights, AreaLights) {
  const auto scene = lit(
      "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2 \"bool twosided\" true " +
      triangle + "AttributeBegin AreaLightSource \"diffuse\" " + triangle + "AttributeEnd " +
      triangle);
  ASSERT_EQ(scene.shapes.size(), 3);
  expect_colour(scene.shapes[0].radiance->value, {2, 4, 6});
  EXPECT_TRUE(scene.shapes[0].emits_behind);
  expect_colour(scene.shapes[1].radiance->value, {1, 1, 1});
  EXPECT_FALSE(scene.shapes[1].emits_behind);
  EXPECT_TRUE(scene.shapes[2].radiance);
  EXPECT_FALSE(lit(triangle).shapes[0].radiance);
  EXPECT_NE(PbrtFolder().error("AreaLightSource \"x\"").find("area light \"x\""),
            std::string::npos);
}

/// Radiance = power / (pi area), of each triangle; of both sides together.
TEST(PbrtLights, AreaLightsOfAPower) {
  const auto scene =
      lit("Scale 2 2 2 AreaLightSource \"diffuse\" \"float power\" 10 " + triangle +
          "Shape \"disk\" AreaLightSource \"diffuse\" \"float power\" 10 \"bool twosided\" true " +
          triangle);
  const auto expect_power = [](const ImportedShape& s, double area) {
    EXPECT_NEAR(double(s.radiance->value.y) * std::numbers::pi * area, 10, .01);
  };
  expect_power(scene.shapes[0], 2);
  expect_power(scene.shapes[1], 4 * std::numbers::pi);
  expect_power(scene.shapes[2], 4);
}

TEST(PbrtLights, ObjectsDoNotShine) {
  const auto scene = lit("ObjectBegin \"o\" AreaLightSource \"diffuse\" " + triangle +
                         "ObjectEnd ObjectInstance \"o\"");
  EXPECT_FALSE(scene.shapes.at(0).radiance);
  EXPECT_NE(noted(scene).find("within an object"), std::string::npos);
}

TEST(PbrtLights, OpaqueThoughTheFileSaysOtherwise) {
  const auto scene = lit("AreaLightSource \"diffuse\" Shape \"disk\" \"float alpha\" 0");
  EXPECT_EQ(scene.shapes.at(0).material->opacity.value.x, 1);
  EXPECT_NE(noted(scene).find("is opaque"), std::string::npos);
}

TEST(PbrtLights, UniformEnvironments) {
  const auto scene =
      lit("LightSource \"infinite\" \"rgb L\" [1 2 3] LightSource \"infinite\" \"float "
          "illuminance\" 1");
  expect_colour(scene.environment->scale,
                Rgb(1, 2, 3) + Rgb(1, 1, 1) * static_cast<float>(1 / std::numbers::pi));
  EXPECT_TRUE(scene.environment->file.empty());
}

/// A column u of pbrt-v3's picture is the azimuth 2 pi u about the light's z axis, a row the angle
/// from it; ImportedEnvironment has pi (1 - 2 u).
TEST(PbrtLights, PicturesOfTheEnvironment) {
  for (const std::string handed : {"", "Scale -1 1 1 "}) {
    PbrtFolder folder;
    folder.write("sky.exr", "");
    const auto scene =
        folder.import(v3_film + handed +
                      "Camera \"perspective\" WorldBegin Rotate 30 1 2 3 LightSource \"infinite\" "
                      "\"string mapname\" \"sky.exr\"");
    const ImportedEnvironment& e = *scene.environment;
    EXPECT_EQ(e.layout, ImportedEnvironment::Layout::equirectangular);
    const double u = .3, theta = 1.1, azimuth = 2 * std::numbers::pi * u;
    V3d expected;
    M44d()
        .setAxisAngle(V3d(1, 2, 3).normalized(), std::numbers::pi / 6)
        .multDirMatrix(V3d(std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth),
                           std::cos(theta)),
                       expected);
    if (handed.empty()) expected.x = -expected.x;
    const double phi = std::numbers::pi * (1 - 2 * u);
    V3d found;
    e.to_world.multDirMatrix(
        V3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)),
        found);
    expect_near(found, expected);
  }
  EXPECT_EQ(lit("LightSource \"infinite\" \"string filename\" \"sky.exr\"").environment->layout,
            ImportedEnvironment::Layout::equal_area);
}

TEST(PbrtLights, EqualAreaMapsKeepAreas) {
  // Known points of Clarberg's map.
  const auto near2 = [](const V2d& a, const V2d& b) {
    EXPECT_LE((a - b).length(), 1e-9) << a << b;
  };
  near2(equal_area_square({0, 0, 1}), {.5, .5});
  near2(equal_area_square({1, 0, 0}), {1, .5});
  near2(equal_area_square({0, 1, 0}), {.5, 1});
  near2(equal_area_square({0, -1, 0}), {.5, 0});
  near2(equal_area_square(V3d(1, 1, 0).normalized()), {.75, .75});
  // Equal areas of the sphere, cells of height and azimuth, count equal areas of the square.
  constexpr int n = 400;
  int left = 0, upper = 0, inner = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double z = 2 * (i + .5) / n - 1, phi = 2 * std::numbers::pi * (j + .5) / n,
                   r = std::sqrt(1 - z * z);
      const V2d p = equal_area_square({r * std::cos(phi), r * std::sin(phi), z});
      left += p.x < .2;
      upper += p.y < .3;
      inner += std::abs(p.x - .5) + std::abs(p.y - .5) < .25;
    }
  }
  EXPECT_NEAR(left, .2 * n * n, n);
  EXPECT_NEAR(upper, .3 * n * n, n);
  EXPECT_NEAR(inner, .125 * n * n, n);
}

TEST(PbrtLights, OthersAreLeftOutOrRefused) {
  EXPECT_NE(noted(lit("LightSource \"goniometric\" \"string filename\" \"x\""))
                .find("a light of this type"),
            std::string::npos);
  EXPECT_NE(PbrtFolder().error("LightSource \"laser\"").find("light \"laser\"; allowed"),
            std::string::npos);
  EXPECT_NE(PbrtFolder().error(v4_film + "LightSource \"point\" \"blackbody I\" 0").find("0 K"),
            std::string::npos);
  EXPECT_NE(
      noted(
          lit("LightSource \"infinite\" \"string filename\" \"sky.exr\" LightSource \"infinite\""))
          .find("a second one"),
      std::string::npos);
}

}  // namespace
}  // namespace lacuna
