// EXT_lights_image_based: the environment that a file names.

#include <gtest/gtest.h>

#include <numbers>

#include "renderer/emitters/environment.h"
#include "renderer/scene/scene.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/images/test_images.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::Bytes;
using test::GlbBuilder;
using test::load;

using Faces = std::array<Bytes, 6>;  // RGBA, 4 x side x side bytes each

/// A triangle in an environment of RGBD faces, as the specification's example writes it.
GlbBuilder lit_by(const Faces& faces, int side) {
  GlbBuilder b = test::triangle_scene();
  Json level;
  for (const Bytes& face : faces) {
    const auto view = b.add_view(test::encode8(side, side, 4, face));
    level.push_back(b.json["images"].size());
    b.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  }
  const Json coefficients(9, {0, 0, 0});
  b.json["extensions"]["EXT_lights_image_based"]["lights"] = {
      {{"intensity", 1},
       {"rotation", {0, 0, 0, 1}},
       {"irradianceCoefficients", coefficients},
       {"specularImageSize", side},
       {"specularImages", {level}}}};
  b.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  return b;
}
Json& light_of(GlbBuilder& b) {
  return b.json["extensions"]["EXT_lights_image_based"]["lights"][0];
}

/// All texels of all faces alike.
Faces uniform(int side, const std::array<std::uint8_t, 4>& texel) {
  Faces faces;
  for (Bytes& face : faces) {
    for (int i = 0; i < side * side; ++i) face.insert(face.end(), texel.begin(), texel.end());
  }
  return faces;
}

/// The axis of a face, and its directions to the right and downwards in the stored image: those of
/// OpenGL's table of cube maps, of which the specification mirrors the columns.
struct FaceAxes {
  V3f axis, right, down;
};
constexpr int side_of_axes = 16;
const std::array<FaceAxes, 6> face_axes{{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                         {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                         {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
                                         {{0, -1, 0}, {-1, 0, 0}, {0, 0, -1}},
                                         {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
                                         {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}}}};

/// Faces whose red says which face it is, and whose green and blue are 1 on the right and below.
Faces marked() {
  Faces faces;
  for (std::size_t f = 0; f < 6; ++f) {
    for (int i = 0; i < side_of_axes * side_of_axes; ++i) {
      const auto of = [](bool on) { return static_cast<std::uint8_t>(on ? 255 : 0); };
      const auto red = static_cast<std::uint8_t>(40 * (f + 1));
      for (const std::uint8_t v : {red, of(i % side_of_axes >= side_of_axes / 2),
                                   of(i / side_of_axes >= side_of_axes / 2), std::uint8_t{255}}) {
        faces[f].push_back(v);
      }
    }
  }
  return faces;
}
float linear(double byte) {
  return static_cast<float>(std::pow((byte / 255 + 0.055) / 1.055, 2.4));
}

void expect_marks(const Environment& e, const M44d& turn) {
  for (std::size_t f = 0; f < 6; ++f) {
    for (const float right : {-0.5F, 0.5F}) {
      for (const float down : {-0.5F, 0.5F}) {
        const FaceAxes& a = face_axes[f];
        V3d w;
        turn.multDirMatrix(V3d(a.axis + right * a.right + down * a.down), w);
        expect_near(e.radiance(V3f(w.normalized())),
                    {linear(40.0 * double(f + 1)), right > 0 ? 1.0F : 0.0F, down > 0 ? 1.0F : 0.0F},
                    1e-5F);
      }
    }
  }
}

TEST(ImageBasedLights, FacesLieAroundTheScene) {
  const Scene scene = test::lit_scene(load(lit_by(marked(), side_of_axes)));
  ASSERT_NE(scene.emitters().environment(), nullptr);
  expect_marks(*scene.emitters().environment(), M44d());
}

TEST(ImageBasedLights, RotationTurnsTheEnvironment) {
  GlbBuilder b = lit_by(marked(), side_of_axes);
  const double h = std::numbers::sqrt2 / 2;
  light_of(b)["rotation"] = {0, 0, h, h};  // a quarter turn about z takes +x to +y
  const Scene scene = test::lit_scene(load(b));
  const M44d turn(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  expect_marks(*scene.emitters().environment(), turn);
}

TEST(ImageBasedLights, ColoursAreDividedByAlphaAndTimesIntensity) {
  GlbBuilder b = lit_by(uniform(4, {255, 188, 0, 51}), 4);
  light_of(b)["intensity"] = 3;
  const Scene scene = test::lit_scene(load(b));
  for (const V3f& w : {V3f(0, 1, 0), V3f(0.6F, -0.48F, 0.64F)}) {
    expect_near(scene.emitters().environment()->radiance(w), {15, 15 * linear(188), 0}, 1e-4F);
  }
}

/// The solid angle of the texels of a face left of x and below y, in [-1, 1] around its centre.
double corner_angle(double x, double y) { return std::atan(x * y / std::sqrt(x * x + y * y + 1)); }

TEST(ImageBasedLights, KeepTheFluxOfEveryTexel) {
  constexpr int side = 16;
  for (const int bright : {0, 5 + side * 9, side / 2 * (side + 1), side - 1}) {
    for (const std::size_t face : {0U, 2U, 5U}) {
      Faces faces = uniform(side, {0, 0, 0, 255});
      const std::vector<std::uint8_t> sun{255, 255, 255, 1};  // radiance 255
      std::copy(sun.begin(), sun.end(), faces[face].begin() + 4 * bright);
      const Scene scene = test::lit_scene(load(lit_by(faces, side)));
      const auto edge = [](int i) { return 2.0 * i / side - 1; };
      const int x = bright % side, y = bright / side;
      const double flux =
          255 * (corner_angle(edge(x + 1), edge(y + 1)) - corner_angle(edge(x), edge(y + 1)) -
                 corner_angle(edge(x + 1), edge(y)) + corner_angle(edge(x), edge(y)));
      // Interpolation moves the light of a texel at an edge by a part of a texel, on which solid
      // angles depend to the first order of 1 / side.
      EXPECT_NEAR(scene.emitters().environment()->integral() / flux, 1, 0.8 / side)
          << face << " " << bright;
    }
  }
}

TEST(ImageBasedLights, KeepTheMeanRadiance) {
  const Scene scene = test::lit_scene(load(lit_by(uniform(8, {188, 188, 188, 102}), 8)));
  const double mean = scene.emitters().environment()->integral() / (4 * std::numbers::pi);
  EXPECT_NEAR(mean, 2.5 * double(linear(188)), 1e-5);
}

TEST(ImageBasedLights, OnlyThatOfTheSceneIsRead) {
  GlbBuilder b = lit_by(uniform(1, {255, 255, 255, 255}), 1);
  b.json["scenes"][0].erase("extensions");
  EXPECT_FALSE(load(b).environment);
}

TEST(ImageBasedLights, OfTheJobGoBeforeThem) {
  const Faces broken = uniform(1, {255, 255, 255, 0});
  const Scene scene = test::lit_scene(
      load(lit_by(broken, 1)),
      EnvironmentImage{std::string(LACUNA_SOURCE_DIR) + "/jobs/scenes/sky.hdr", 1, 0});
  EXPECT_NE(scene.emitters().environment(), nullptr);
  EXPECT_EQ(scene.textures_decoded(), 0);
}

TEST(ImageBasedLights, BadOnesAreRefusedByName) {
  const auto refused = [](auto change, const std::string& expected, std::uint8_t alpha = 255) {
    GlbBuilder b = lit_by(uniform(2, {255, 255, 255, alpha}), 2);
    change(b);
    try {
      test::lit_scene(load(b));
      ADD_FAILURE() << "not refused: " << expected;
    } catch (const SceneError& e) {
      EXPECT_NE(std::string(e.what()).find(expected), std::string::npos) << e.what();
    }
  };
  const auto set = [](const char* key, const Json& value) {
    return [=](GlbBuilder& b) { light_of(b)[key] = value; };
  };
  refused([](GlbBuilder&) {}, "is a colour over alpha 0", 0);
  refused(set("specularImageSize", 4), "has 2 x 2 texels; allowed: 4 x 4");
  refused(set("specularImageSize", 8192), "an integer from 1 to 2048");
  refused(set("specularImages", Json::array()), "specularImages is missing or empty");
  refused(set("specularImages", {{0, 1, 2, 3, 4}}), "lists of 6 images");
  refused(set("specularImages", {{0, 1, 2, 3, 4, 5}, {0, 1, 2, 3, 4, 6}}), "an index below 6");
  refused(set("specularImages", {0}), "found number 0");
  refused(set("rotation", {0, 0, 0, 2}), "a quaternion of length 1");
  refused(set("intensity", -1), "intensity: found number -1");
  refused(set("intensity", 1e13), "a number from 0 to 1e12");
  refused(
      [](GlbBuilder& b) {
        b.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
      },
      "an index below 1");
}

}  // namespace
}  // namespace lacuna
