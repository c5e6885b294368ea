#include "jobs/import/pbrt/pbrt_camera.h"

#include <numbers>

#include "tests/jobs/import/pbrt/pbrt_fixture.h"

namespace lacuna {
namespace {

/// The camera and picture of statements before the world.
ImportedScene viewed(const std::string& statements, const std::string& film = v4_film) {
  return PbrtFolder().import(film + statements + " WorldBegin");
}

double fov_of(const ImportedScene& scene) {
  return scene.cameras.at(0).yfov * 180 / std::numbers::pi;
}

V3d axis(const ImportedScene& scene, int i) {
  const M44d& m = scene.cameras.at(0).to_world;
  return {m[i][0], m[i][1], m[i][2]};
}

TEST(PbrtCamera, FieldOfViewIsThatOfTheShorterSide) {
  EXPECT_NEAR(fov_of(viewed("Camera \"perspective\" \"float fov\" 40")), 40, 1e-9);
  const std::string tall = "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 60\n";
  const double half = std::tan(20 * std::numbers::pi / 180);
  EXPECT_NEAR(fov_of(viewed("Camera \"perspective\" \"float fov\" 40", tall)),
              2 * std::atan(2 * half) * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(fov_of(viewed("")), 90, 1e-9);
}

TEST(PbrtCamera, TheWorldIsMirroredUnlessItsTransformMirrors) {
  const auto scene = viewed("LookAt 1 2 3  1 2 8  0 1 0 Camera \"perspective\"");
  expect_near(axis(scene, 3), V3d(-1, 2, 3));
  expect_near(axis(scene, 2), V3d(0, 0, -1));  // looks along +z
  expect_near(axis(scene, 1), V3d(0, 1, 0));
  expect_near(axis(scene, 0), V3d(-1, 0, 0));  // pbrt's +x, to the right, mirrored
  const auto mirrored = viewed("Scale -1 1 1 LookAt 1 2 3  1 2 8  0 1 0 Camera \"perspective\"");
  expect_near(axis(mirrored, 3), V3d(1, 2, 3));
  expect_near(axis(mirrored, 0), V3d(-1, 0, 0));  // right of a right-handed view along +z
}

TEST(PbrtCamera, ScreenWindowsAreCropsOfAPictureAboutTheAxis) {
  const auto off = viewed("Camera \"perspective\" \"float screenwindow\" [-1 3 -1 1]");
  EXPECT_EQ(off.picture.resolution, (std::array{96, 32}));
  ASSERT_TRUE(off.picture.crop_from);
  EXPECT_EQ(*off.picture.crop_from, (std::array{32, 0}));
  EXPECT_EQ(off.picture.crop_size, (std::array{64, 32}));
  EXPECT_NEAR(fov_of(off), 90, 1e-9);
  const auto low = viewed("Camera \"perspective\" \"float screenwindow\" [-1 1 -.75 .25]");
  EXPECT_EQ(low.picture.resolution, (std::array{64, 48}));
  EXPECT_EQ(*low.picture.crop_from, (std::array{0, 16}));
  EXPECT_NEAR(fov_of(low), 2 * std::atan(.75) * 180 / std::numbers::pi, 1e-9);
}

TEST(PbrtCamera, CropWindowsAreSharesOfTheFilm) {
  const auto scene = viewed("",
                            "Film \"image\" \"integer xresolution\" 64 \"integer yresolution\" 32 "
                            "\"float cropwindow\" [.25 .5 0 .75]\n");
  EXPECT_EQ(scene.picture.resolution, (std::array{64, 32}));
  EXPECT_EQ(*scene.picture.crop_from, (std::array{16, 0}));
  EXPECT_EQ(scene.picture.crop_size, (std::array{16, 24}));
  EXPECT_FALSE(viewed("").picture.crop_from);
}

TEST(PbrtCamera, LensAndOrthographicHeightScaleWithTheCamera) {
  const auto lens = viewed(
      "Scale .5 .5 .5 Camera \"perspective\" \"float lensradius\" 3 \"float focaldistance\" 10");
  EXPECT_NEAR(lens.cameras[0].aperture, 6, 1e-9);
  EXPECT_NEAR(lens.cameras[0].focus, 20, 1e-9);
  EXPECT_TRUE(lens.notes.empty()) << noted(lens);
  const auto flat =
      viewed("Scale .5 .5 .5 Camera \"orthographic\" \"float screenwindow\" [-4 4 -2 2]");
  EXPECT_EQ(flat.cameras[0].projection, Projection::orthographic);
  EXPECT_NEAR(flat.cameras[0].height, 8, 1e-9);
}

/// pbrt's panorama has +x of the camera in column 0, -x in the middle, and -z right of it.
TEST(PbrtCamera, PanoramasLookAlongMinusX) {
  const auto scene = viewed("Camera \"spherical\" \"string mapping\" \"equirectangular\"");
  EXPECT_EQ(scene.cameras[0].projection, Projection::panorama);
  expect_near(axis(scene, 2), V3d(1, 0, 0));
  expect_near(axis(scene, 0), V3d(0, 0, -1));
  EXPECT_TRUE(scene.notes.empty()) << noted(scene);
  const auto old = viewed("Scale -1 1 1 Camera \"environment\"", v3_film);
  // pbrt's -x is the world's +x, which the mirroring turns into -x.
  expect_near(axis(old, 2), V3d(1, 0, 0));
  expect_near(axis(old, 0), V3d(0, 0, -1));
}

TEST(PbrtCamera, ExposureIsAFactorOfAllLight) {
  const std::string film = "Film \"rgb\" \"float iso\" 200 \"string sensor\" \"cie1931\"\n";
  const PbrtFolder folder;
  const auto scene = folder.import(film +
                                   "Camera \"perspective\" \"float shutterclose\" .25 WorldBegin "
                                   "LightSource \"point\" \"rgb I\" [2 4 6] "
                                   "LightSource \"infinite\" \"rgb L\" [1 1 1] "
                                   "AreaLightSource \"diffuse\" \"rgb L\" [8 8 8] " +
                                   triangle);
  expect_colour(scene.lights.at(0).intensity, {1, 2, 3});
  expect_colour(scene.environment->scale, {.5F, .5F, .5F});
  expect_colour(scene.shapes.at(0).radiance->value, {4, 4, 4});
  expect_colour(
      folder
          .import("Film \"image\" \"float scale\" 3\nWorldBegin LightSource \"point\" \"rgb "
                  "I\" [1 1 1]")
          .lights.at(0)
          .intensity,
      {3, 3, 3});
}

TEST(PbrtCamera, DepthCountsEdges) {
  EXPECT_EQ(viewed("").picture.max_depth, 6);
  EXPECT_EQ(viewed("Integrator \"path\" \"integer maxdepth\" 1").picture.max_depth, 2);
  EXPECT_TRUE(viewed("Integrator \"volpath\" \"integer maxdepth\" 100").notes.empty());
  EXPECT_FALSE(viewed("Integrator \"directlighting\"", v3_film).notes.empty());
}

TEST(PbrtCamera, FiltersAreBoxesOrTents) {
  const auto box = viewed("PixelFilter \"box\"");
  EXPECT_FALSE(box.picture.tent_filter);
  EXPECT_EQ(noted(box), "");
  const auto tent = viewed("PixelFilter \"triangle\" \"float xradius\" 1 \"float yradius\" 1");
  EXPECT_TRUE(tent.picture.tent_filter);
  EXPECT_EQ(noted(tent), "");
  EXPECT_NE(noted(viewed("PixelFilter \"triangle\"")), "");
  EXPECT_NE(noted(viewed("PixelFilter \"gaussian\" \"float xwidth\" 2", v3_film)), "");
}

TEST(PbrtCamera, OtherCamerasAreNotedOrRefused) {
  EXPECT_NE(noted(viewed("Camera \"realistic\" \"string lensfile\" \"x.dat\"")).find("pinhole"),
            std::string::npos);
  EXPECT_NE(PbrtFolder().error("Camera \"round\" WorldBegin").find("camera \"round\"; allowed"),
            std::string::npos);
  EXPECT_EQ(PbrtFolder().import("Film \"image\"\nWorldBegin").picture.resolution,
            (std::array{640, 480}));
  EXPECT_EQ(PbrtFolder().import("Film \"rgb\"\nWorldBegin").picture.resolution,
            (std::array{1280, 720}));
}

}  // namespace
}  // namespace lacuna
