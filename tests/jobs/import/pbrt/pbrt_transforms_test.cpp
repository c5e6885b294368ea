#include "jobs/import/pbrt/pbrt_transforms.h"

#include <numbers>

#include "tests/jobs/import/pbrt/pbrt_fixture.h"

namespace lacuna {
namespace {

/// The transform that `statements` of a world lead to, without the mirroring of the world.
M44d transform_of(const std::string& statements) {
  const PbrtFolder folder;
  pbrt::Tokens tokens(folder.write("a.pbrt", statements));
  pbrt::CurrentTransform ctm;
  while (const auto t = tokens.next()) {
    EXPECT_TRUE(pbrt::read_transform(t->text, tokens, t->place, ctm)) << t->text;
  }
  return ctm.start();
}

TEST(PbrtTransforms, ApplyTheLastFirst) {
  expect_near(V3d(1, 1, 1) * transform_of("Translate 10 0 0 Scale 2 3 4"), V3d(12, 3, 4));
  expect_near(V3d(1, 1, 1) * transform_of("Scale 2 3 4 Translate 10 0 0"), V3d(22, 3, 4));
  expect_near(V3d(1, 0, 0) * transform_of("Rotate 90 0 0 1"), V3d(0, 1, 0));
  expect_near(V3d(1, 0, 0) * transform_of("Rotate [30 0 2 0]"), V3d(std::sqrt(.75), 0, -.5));
  expect_near(V3d(1, 2, 3) * transform_of("Translate 7 7 7 Identity"), V3d(1, 2, 3));
}

TEST(PbrtTransforms, MatricesStandByColumns) {
  const std::string m = "[0 1 0 0  -1 0 0 0  0 0 1 0  5 6 7 1]";
  expect_near(V3d(1, 0, 0) * transform_of("Transform " + m), V3d(5, 7, 7));
  expect_near(V3d(1, 0, 0) * transform_of("Scale 2 2 2 ConcatTransform " + m), V3d(10, 14, 14));
  expect_near(V3d(1, 0, 0) * transform_of("Scale 2 2 2 Transform " + m), V3d(5, 7, 7));
}

TEST(PbrtTransforms, LookAtIsCameraFromWorld) {
  const M44d m = transform_of("LookAt 1 2 3  1 2 8  0 1 0");
  expect_near(V3d(1, 2, 3) * m, V3d(0, 0, 0));
  expect_near(V3d(1, 2, 8) * m, V3d(0, 0, 5));  // ahead is z
  expect_near(V3d(2, 2, 3) * m, V3d(1, 0, 0));  // up x ahead is right
  expect_near(V3d(1, 3, 3) * m, V3d(0, 1, 0));
}

TEST(PbrtTransforms, WhatHasNoInverseIsLeftOut) {
  const PbrtFolder folder;
  const std::string flat = "Transform [1 0 0 0  0 1 0 0  0 0 0 0  0 0 0 1] ";
  const auto scene =
      folder.import(v4_film + "WorldBegin ObjectBegin \"o\" " + triangle + " ObjectEnd " + flat +
                    triangle + "ObjectInstance \"o\" LightSource \"point\" Identity Scale 1 0 1\n" +
                    triangle + "Identity " + triangle);
  EXPECT_EQ(scene.shapes.size(), 1);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_NE(noted(scene).find("ObjectInstance: its transform has no inverse"), std::string::npos);
  EXPECT_NE(folder.error("Scale 1 0 1 Camera \"perspective\"").find("no inverse"),
            std::string::npos);
  EXPECT_NE(
      noted(folder.import("CoordSysTransform \"x\" " + v4_film)).find("no coordinate system \"x\""),
      std::string::npos);
}

TEST(PbrtTransforms, NumbersAreThoseOfTheStatement) {
  const PbrtFolder folder;
  EXPECT_NE(folder.error("Transform [1 0 0 1  0 1 0 0  0 0 1 0  0 0 0 1]").find("projective"),
            std::string::npos);
  EXPECT_NE(folder.error("Transform [1 0 0 0]").find("expected 16 finite numbers"),
            std::string::npos);
  EXPECT_NE(folder.error("Translate 1 2").find("expected 3 finite numbers"), std::string::npos);
  EXPECT_NE(folder.error("Rotate 3 0 0 0").find("axis"), std::string::npos);
  EXPECT_NE(folder.error("LookAt 0 0 0  0 0 1  0 0 2").find("parallel"), std::string::npos);
  EXPECT_EQ(folder.error("Scale 1e-6 1e-6 1e-6"), "no error");
}

/// The transform to the world of one triangle after `statements`; the world is not mirrored.
M44d placed(const std::string& statements) {
  const PbrtFolder folder;
  const auto scene = folder.import(v4_film + "Scale -1 1 1 Camera \"perspective\" WorldBegin " +
                                   statements + "\n" + triangle);
  EXPECT_EQ(scene.shapes.size(), 1);
  return scene.shapes.at(0).to_world;
}

TEST(PbrtTransforms, ScopesRestoreThem) {
  EXPECT_EQ(placed("Translate 1 0 0 AttributeBegin Translate 1 0 0 AttributeEnd")[3][0], 1);
  EXPECT_EQ(placed("Translate 1 0 0 TransformBegin Translate 1 0 0 TransformEnd")[3][0], 1);
}

TEST(PbrtTransforms, CoordinateSystemsHaveNames) {
  EXPECT_EQ(placed("AttributeBegin Translate 4 0 0 CoordinateSystem \"there\" AttributeEnd "
                   "CoordSysTransform \"there\"")[3][0],
            4);
  EXPECT_EQ(placed("Translate 4 0 0 CoordSysTransform \"world\"")[3][0], 0);
  EXPECT_EQ(placed("CoordSysTransform \"camera\"")[0][0], -1);
}

TEST(PbrtTransforms, AnimatedOnesStandStillAtTheStart) {
  const PbrtFolder folder;
  const auto scene =
      folder.import(v4_film +
                    "WorldBegin ActiveTransform EndTime Translate 9 0 0 "
                    "ActiveTransform StartTime Translate 0 2 0 ActiveTransform All " +
                    triangle);
  EXPECT_EQ(scene.shapes[0].to_world[3][0], 0);
  EXPECT_EQ(scene.shapes[0].to_world[3][1], 2);
  EXPECT_NE(noted(scene).find("stands still"), std::string::npos);
}

}  // namespace
}  // namespace lacuna
