#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "jobs/import/mitsuba/read_mitsuba.h"
#include "jobs/import/scene_write.h"
#include "jobs/spec/job_json.h"
#include "renderer/core/scene_error.h"
#include "renderer/gltf/gltf_load.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

const std::string small_scene = R"(<?xml version="1.0"?>
<scene version="3.0.0">
  <default name="size" value="64"/>
  <default name="sizes" value="32"/>
  <integrator type="path"><integer name="max_depth" value="5"/></integrator>
  <sensor type="perspective" id="eye">
    <float name="fov" value="60"/>
    <transform name="to_world"><lookat origin="0,1,5" target="0,1,0" up="0,1,0"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="$size"/><integer name="height" value="$sizes"/>
      <rfilter type="box"/>
    </film>
  </sensor>
  <bsdf type="twosided" id="white"><bsdf type="diffuse">
    <rgb name="reflectance" value=".25, .5 .75"/></bsdf></bsdf>
  <alias id="white" as="paint"/>
  <shape type="rectangle" id="floor"><ref id="paint"/>
    <transform name="to_world"><scale value="2"/><rotate x="1" angle="-90"/></transform></shape>
  <shape type="sphere" id="lamp"><float name="radius" value=".5"/>
    <point name="center" x="0" y="2" z="0"/>
    <emitter type="area"><rgb name="radiance" value="4 2 1"/></emitter></shape>
  <shape type="sphere"><ref id="white"/><point name="center" value="1, 1, 0"/></shape>
  <emitter type="point"><point name="position" x="0" y="3" z="0"/>
    <rgb name="intensity" value="10, 20, 5"/></emitter>
</scene>)";

struct Written {
  TemporaryFolder folder;
  std::vector<ImportNote> notes;
  SceneData scene;
  JobSpec job;

  explicit Written(const ImportedScene& imported)
      : notes(write_imported_scene(imported, folder / "small")),
        scene(load_gltf(folder / "small/scene.glb")),
        job(parse_job(content_of(folder / "small/job.json"))) {}
};

const Mesh& mesh_called(const SceneData& scene, const std::string& name) {
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.name.find(name) != std::string::npos) return mesh;
  }
  ADD_FAILURE() << name;
  return scene.meshes[0];
}

TEST(MitsubaScene, BecomesAGlbAndAJob) {
  const Written written(read_mitsuba_text(small_scene));
  EXPECT_TRUE(written.scene.warnings.empty());
  ASSERT_EQ(written.scene.meshes.size(), 3U);
  const Mesh& floor = mesh_called(written.scene, "floor");
  const Material& paint = written.scene.materials[floor.material];
  EXPECT_EQ(paint.base_color, Rgb(.25F, .5F, .75F));
  EXPECT_EQ(paint.specular, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(floor.positions[i].y, 0, 1e-6);
    EXPECT_NEAR(std::abs(floor.positions[i].x), 2, 1e-6);
    EXPECT_NEAR(floor.normals[i].y, 1, 1e-6);
  }
  const Material& light = written.scene.materials[mesh_called(written.scene, "lamp").material];
  EXPECT_EQ(light.emission, Rgb(4, 2, 1));
  EXPECT_EQ(light.base_color, Rgb(0, 0, 0));
  EXPECT_FALSE(light.double_sided);
  ASSERT_EQ(written.scene.lights.size(), 1U);
  EXPECT_EQ(written.scene.lights[0].intensity, Rgb(10, 20, 5));
  EXPECT_EQ(written.scene.lights[0].position, V3f(0, 3, 0));
}

TEST(MitsubaScene, JobHasCameraPictureAndDepth) {
  const Written written(read_mitsuba_text(small_scene));
  EXPECT_EQ(written.job.scene, "small/scene.glb");
  EXPECT_EQ(written.job.resolution, (std::array<int, 2>{64, 32}));
  EXPECT_EQ(written.job.light_units, LightUnits::radiometric);
  EXPECT_FALSE(written.job.environment);
  ASSERT_EQ(written.scene.cameras.size(), 1U);
  const CameraData& camera = written.scene.cameras[0];
  EXPECT_EQ(camera.name, "eye");
  // fov 60 along x, 64 x 32 pixels.
  EXPECT_NEAR(camera.yfov, 2 * std::atan(std::tan(std::numbers::pi / 6) / 2), 1e-6);
  // Looks along -z of the world: x to the right, y up.
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(camera.to_world[i][k], i == k ? 1 : 0, 1e-6);
  }
  EXPECT_NEAR(camera.to_world[3][2], 5, 1e-6);
}

TEST(MitsubaScene, ShapesOfOneMeshShareIt) {
  const ImportedScene imported = read_mitsuba_text(small_scene);
  ASSERT_EQ(imported.shapes.size(), 3U);
  EXPECT_EQ(imported.shapes[1].mesh, imported.shapes[2].mesh);
  const TemporaryFolder folder;
  write_imported_scene(imported, folder / "a");
  const std::string glb = content_of(folder / "a/scene.glb");
  EXPECT_LT(glb.size(),
            2 * (sizeof(V3f) * 2 + sizeof(V2f)) * imported.shapes[1].mesh->positions.size());
}

TEST(MitsubaScene, InstancesPlaceTheShapesOfAGroup) {
  const ImportedScene imported = read_mitsuba_text(R"(<scene version="0.6.0">
    <sensor type="orthographic"/>
    <shape type="shapegroup" id="pair">
      <shape type="cube"><transform name="toWorld"><scale value="2"/></transform></shape>
      <shape type="rectangle"/>
    </shape>
    <shape type="instance"><ref id="pair"/>
      <transform name="toWorld"><translate x="5"/></transform></shape>
    <shape type="instance"><ref id="pair"/>
      <transform name="toWorld"><rotate y="1" angle="90"/></transform></shape>
  </scene>)");
  ASSERT_EQ(imported.shapes.size(), 4U);
  EXPECT_EQ(V3d(1, 1, 1) * imported.shapes[0].to_world, V3d(7, 2, 2));
  EXPECT_EQ(imported.shapes[1].mesh, imported.shapes[3].mesh);
  const V3d turned = V3d(1, 0, 0) * imported.shapes[3].to_world;
  EXPECT_NEAR(turned.z, -1, 1e-12);
}

std::string refusal_of_scene(const std::string& inner) {
  return message_of<SceneError>(
      [&] { read_mitsuba_text("<scene version='0.6.0'>\n" + inner + "\n</scene>"); });
}

TEST(MitsubaScene, SkyAndSunAreOneEnvironment) {
  const auto daylight_of = [](const std::string& inner) {
    const ImportedScene s =
        read_mitsuba_text("<scene version='0.6.0'><emitter type='" + inner + "</emitter></scene>");
    EXPECT_EQ(s.environment.has_value() && s.environment->daylight, true) << inner;
    return std::pair(s.environment->daylight.value(), s);
  };
  const auto sky = daylight_of("sky'><float name='scale' value='8'/>").first;
  EXPECT_EQ(sky.sky_scale, 8);
  EXPECT_EQ(sky.sun_scale, 0);
  const auto both =
      daylight_of(
          "sunsky'><vector name='sunDirection' x='0' y='3' z='4'/><transform name='toWorld'>"
          "<rotate y='1' angle='90'/></transform><float name='sunScale' value='2'/>")
          .first;
  EXPECT_NEAR((both.to_sun - V3d(-.8, .6, 0)).length(), 0, 1e-12) << "local";
  EXPECT_EQ(both.sun_scale, 2);
  EXPECT_EQ(both.sky_scale, 1);
  const auto [point, scene] = daylight_of(
      "sunsky'><vector name='sunDirection' x='0' y='1' z='0'/>"
      "<float name='sunRadiusScale' value='0'/>");
  EXPECT_EQ(point.sun_scale, 0);
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_NEAR(scene.lights[0].direction.y, -1, 1e-12);
}

TEST(MitsubaScene, RefusesByPlaceAndName) {
  EXPECT_TRUE(
      contains(refusal_of_scene("<emitter type='sky'><float name='hour' value='23'/></emitter>"),
               "below the horizon"));
  EXPECT_TRUE(contains(refusal_of_scene("<shape type='cube'><ref id='x'/></shape>"),
                       "names \"x\", which no element has as its id"));
  EXPECT_TRUE(contains(refusal_of_scene("<bsdf type='diffuse' id='a'/><bsdf type='diffuse' "
                                        "id='a'/>"),
                       "has an id that another element has"));
  EXPECT_TRUE(contains(refusal_of_scene("<shape type='sphere'><float name='radius' "
                                        "value='$r'/></shape>"),
                       "no <default> says what \"$r\" is"));
  EXPECT_TRUE(contains(refusal_of_scene("<shape type='sphere'><float name='radius' "
                                        "value='x1'/></shape>"),
                       "has \"x1\"; allowed: a number"));
  EXPECT_TRUE(contains(refusal_of_scene("<soup/>"), "is no element that is read"));
  EXPECT_TRUE(contains(refusal_of_scene("<shape type='obj'><string name='filename' "
                                        "value='a.obj'/></shape>"),
                       "names a file"));
}

TEST(MitsubaScene, NotesParametersThatItDoesNotRead) {
  const ImportedScene scene = read_mitsuba_text(R"(<scene version="0.6.0">
    <sensor type="orthographic"/>
    <shape type="cube"><bsdf type="diffuse"><float name="shine" value="1"/></bsdf></shape>
    <shape type="cube"><bsdf type="diffuse"><float name="shine" value="1"/></bsdf></shape>
  </scene>)");
  ASSERT_EQ(scene.notes.size(), 1U);
  EXPECT_EQ(scene.notes[0].place, "scene.xml:3");
  EXPECT_EQ(scene.notes[0].treatment, "left out");
  EXPECT_EQ(scene.notes[0].how, "its float \"shine\" is not read (and 1 more of its kind)");
}

/// Numerically: Mitsuba's intensity is 1 within the beam and falls linearly with the angle to 0 at
/// the cutoff; glTF's falls as the square of a ramp of the cosine.
TEST(MitsubaScene, SpotsKeepTheirFlux) {
  const ImportedScene scene = read_mitsuba_text(
      "<scene version='0.6.0'><emitter type='spot'><float name='cutoffAngle' value='40'/><float "
      "name='beamWidth' value='10'/></emitter></scene>");
  ASSERT_EQ(scene.lights.size(), 1U);
  const double rim = std::cos(scene.lights[0].outer_cone),
               inner = std::cos(scene.lights[0].inner_cone);
  double theirs = 0, ours = 0;
  constexpr int steps = 20000;
  for (int i = 0; i < steps; ++i) {
    const double degrees = 40 * (i + .5) / steps, t = degrees * std::numbers::pi / 180;
    const double ramp = std::clamp((std::cos(t) - rim) / (inner - rim), 0.0, 1.0);
    theirs += std::sin(t) * std::min(1.0, (40 - degrees) / 30);
    ours += std::sin(t) * ramp * ramp;
  }
  EXPECT_NEAR(ours / theirs, 1, 1e-5);
  EXPECT_EQ(scene.lights[0].direction, V3d(0, 0, 1));
}

double yfov_of(const std::string& sensor) {
  const ImportedScene scene = read_mitsuba_text(
      "<scene version='0.6.0'><sensor type='perspective'>" + sensor +
      "<film type='hdrfilm'><integer name='width' value='200'/><integer name='height' "
      "value='100'/></film></sensor></scene>");
  return 2 * std::atan(std::tan(scene.cameras.at(0).yfov / 2)) * 180 / std::numbers::pi;
}

TEST(MitsubaScene, FieldsOfViewByAxisAndFocalLength) {
  const auto along = [](const char* axis) {
    return yfov_of(std::string("<float name='fov' value='50'/><string name='fovAxis' value='") +
                   axis + "'/>");
  };
  const double half = std::tan(25 * std::numbers::pi / 180);
  const auto degrees = [](double tangent) {
    return 2 * std::atan(tangent) * 180 / std::numbers::pi;
  };
  EXPECT_NEAR(along("y"), 50, 1e-9);
  EXPECT_NEAR(along("smaller"), 50, 1e-9);
  EXPECT_NEAR(along("x"), degrees(half / 2), 1e-9);
  EXPECT_NEAR(along("larger"), degrees(half / 2), 1e-9);
  EXPECT_NEAR(along("diagonal"), degrees(half / std::sqrt(5)), 1e-9);
  // A film of 36 x 24 mm has a diagonal of 43.27 mm.
  EXPECT_NEAR(yfov_of("<string name='focalLength' value='35mm'/>"),
              degrees(43.2666 / 70 / std::sqrt(5)), 1e-4);
}

/// Names and treatments of the notes, in order.
std::string treatments(const ImportedScene& scene) {
  std::string out;
  for (const ImportNote& n : scene.notes) out += n.name + " " + n.treatment + "; ";
  return out;
}

TEST(MitsubaScene, WhatIsNotReadIsNamedAndTheRestStays) {
  const ImportedScene scene = read_mitsuba_text(R"(<scene version="3.0.0">
    <volume type="gridvolume" id="v"/><rfilter type="gaussian" id="r"/>
    <sensor type="distant" id="far"/><sensor type="orthographic" id="eye"/>
    <emitter type="projector"><texture type="bitmap" name="irradiance"/></emitter>
    <emitter type="point"/>
    <shape type="hair" id="h"><string name="filename" value="a.hair"/><bsdf type="hair"/></shape>
    <shape type="cube"><emitter type="directionalarea"/></shape>
  </scene>)");
  EXPECT_EQ(treatments(scene),
            "sensor \"far\" (distant) left out; emitter (projector) left out; shape \"h\" (hair) "
            "left out; emitter (directionalarea) left out; ");
  EXPECT_EQ(scene.notes[0].place, "scene.xml:3");
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_EQ(scene.lights.size(), 1U);
  ASSERT_EQ(scene.shapes.size(), 1U);
  EXPECT_FALSE(scene.shapes[0].radiance);
  EXPECT_EQ(scene.shapes[0].material->type, ImportedMaterial::Type::diffuse);
}

TEST(MitsubaScene, ShapesReferToEmittersOfTheScene) {
  const ImportedScene scene = read_mitsuba_text(R"(<scene version="2.2.1">
    <sensor type="orthographic"/><shape type="sphere"><ref id="lamp"/></shape>
    <emitter type="area" id="lamp"><rgb name="radiance" value="3 2 1"/></emitter>
    <emitter type="area" id="spare"/>
  </scene>)");
  EXPECT_EQ(scene.shapes.at(0).radiance.value().value, Rgb(3, 2, 1));
  EXPECT_EQ(treatments(scene), "shapes (sphere) approximated; emitter \"spare\" (area) left out; ");
}

TEST(MitsubaScene, AnimationsStandAtTheirBeginning) {
  const ImportedScene scene = read_mitsuba_text(R"(<scene version="0.6.0">
    <sensor type="orthographic"/><shape type="cube"><animation name="toWorld">
      <transform time="0"><translate x="3"/></transform>
      <transform time="1"><translate x="9"/></transform></animation></shape></scene>)");
  EXPECT_EQ(V3d(0, 0, 0) * scene.shapes.at(0).to_world, V3d(3, 0, 0));
  EXPECT_EQ(treatments(scene), "shape (cube) approximated; ");
}

/// That of Mitsuba 3: 45 degrees across, all shapes along +z.
TEST(MitsubaScene, WithoutASensorAllIsSeen) {
  const ImportedScene scene = read_mitsuba_text(
      "<scene version='2.1.0'><shape type='cube'><transform name='to_world'><scale x='2'/>"
      "<translate y='5'/></transform></shape></scene>");
  ASSERT_EQ(scene.cameras.size(), 1U);
  const M44d& m = scene.cameras[0].to_world;
  const double distance = 4 / (2 * std::tan(std::numbers::pi / 8));
  EXPECT_LT((V3d(0, 0, 0) * m - V3d(0, 5, -1 - distance)).length(), 1e-12);
  EXPECT_LT((V3d(0, 0, -1) * m - V3d(0, 5, -distance)).length(), 1e-12) << "ahead is +z";
  EXPECT_NEAR(std::tan(scene.cameras[0].yfov / 2), .75 * std::tan(std::numbers::pi / 8), 1e-12);
  EXPECT_TRUE(contains(treatments(scene), "approximated"));
  EXPECT_TRUE(read_mitsuba_text("<scene version='2.1.0'/>").cameras.empty());
}

TEST(MitsubaScene, OtherSensorsBecomeTheNearest) {
  const auto camera = [](const std::string& sensor) {
    return read_mitsuba_text("<scene version='3.0.0'>" + sensor + "</scene>").cameras;
  };
  EXPECT_EQ(camera("<sensor type='spherical'/>").at(0).projection, Projection::panorama);
  EXPECT_EQ(camera("<sensor type='telecentric'/>").at(0).projection, Projection::orthographic);
  EXPECT_NEAR(
      camera("<sensor type='perspective_rdist'><float name='fov' value='90'/></sensor>").at(0).yfov,
      2 * std::atan(.75), 1e-12);
  EXPECT_EQ(camera("<sensor type='batch'><sensor type='perspective'/><sensor type='thinlens'/>"
                   "</sensor>")
                .size(),
            2U);
}

TEST(MitsubaScene, MediaOfUnknownCoefficientsAbsorbNothing) {
  const auto absorption = [](const std::string& medium) {
    return read_mitsuba_text(
               "<scene version='0.6.0'><sensor type='orthographic'/><shape "
               "type='cube'><bsdf type='dielectric'/><medium name='interior' type='" +
               medium + "</medium></shape></scene>")
        .shapes.at(0)
        .material->absorption;
  };
  EXPECT_EQ(absorption("homogeneous'><rgb name='sigmaA' value='1 2 3'/>"), Rgb(1, 2, 3));
  EXPECT_EQ(absorption("homogeneous'><string name='material' value='milk'/>"), Rgb(0));
  EXPECT_EQ(absorption("heterogeneous'><volume name='density' type='gridvolume'/>"), Rgb(0));
  EXPECT_EQ(absorption("homogeneous'><volume name='sigma_t' type='gridvolume'/>"), Rgb(0));
}

}  // namespace
}  // namespace lacuna
