#include "jobs/run/run_job.h"

#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/images/exr_write.h"
#include "tests/jobs/run/run_job_fixture.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using nlohmann::json;
using test::RunJob;

TEST_F(RunJob, SaysWhenPreparationExceedsTheBudget) {
  JobSpec s = spec();
  s.budget = {};
  s.budget.seconds = 1e-6;
  const JobFolder folder = create(s);
  ASSERT_EQ(run(folder), Outcome::done);
  const json budget = report(folder)["budget"];
  EXPECT_EQ(budget["seconds"], 1e-6);
  EXPECT_GT(budget["preparation_seconds"], 1e-6);
  ASSERT_FALSE(observer.warnings.empty());
  EXPECT_EQ(observer.warnings.back().rfind("preparation took", 0), 0u) << observer.warnings.back();
}

/// A wall, half of it a mirror, between a dim lamp in front and a bright one behind. The camera
/// lies exactly in another wall, at `z` = 2, or off it.
test::Bytes wall_between(float z) {
  test::GlbBuilder b;
  const auto paint = b.add_material({{"name", "paint"}});
  const auto mirror =
      b.add_material({{"name", "mirror"}, {"pbrMetallicRoughness", {{"roughnessFactor", 0}}}});
  b.add_node({{"mesh", b.add_quad({-4, -4, 0}, {4, 0, 0}, {0, 8, 0}, int(paint))}});
  b.add_node({{"mesh", b.add_quad({0, -4, 0}, {4, 0, 0}, {0, 8, 0}, int(mirror))}});
  b.add_node({{"mesh", b.add_quad({-4, -4, 2}, {0, 8, 0}, {8, 0, 0}, int(paint))}});
  b.add_light({{"type", "point"}, {"name", "dim"}, {"intensity", 1}},
              {{"translation", {-0.5, 0, 1}}});
  b.add_light({{"type", "point"}, {"intensity", 1000}}, {{"translation", {0, 0, -1}}});
  b.add_camera("eye", {0, 0, z}, 0.8);
  return b.glb();
}

TEST_F(RunJob, WarnsOfWhatLightPathsDoNotShow) {
  LightSettings few;
  few.light_paths = 1;
  JobSpec s = spec("wall.glb", 1);
  s.integrator = few;
  temp.write("wall.glb", wall_between(2));
  ASSERT_EQ(run(create(s)), Outcome::done);
  const auto says = [&](const std::string& a, const std::string& b) {
    return std::any_of(observer.warnings.begin(), observer.warnings.end(), [&](const auto& w) {
      return w.find(a) != std::string::npos && w.find(b) != std::string::npos;
    });
  };
  EXPECT_TRUE(says("mirrors and clear glass are black", "\"mirror\""));
  EXPECT_TRUE(says("1 light paths in all", "\"dim\""));
  observer.warnings.clear();
  s.integrator = PathSettings{};
  ASSERT_EQ(run(create(s, "by path")), Outcome::done);
  EXPECT_FALSE(says("black", "") || says("light paths", ""));
}

// Light paths end at the eye, and the wall that it lies in does not hide it.
TEST_F(RunJob, ACameraInAWallSeesTheRoom) {
  const auto mean = [&](float z, const JobIntegrator& integrator, const std::string& name) {
    JobSpec s = spec("wall.glb", 32);
    s.integrator = integrator;
    temp.write("wall.glb", wall_between(z));
    const JobFolder folder = create(s, name);
    EXPECT_EQ(run(folder), Outcome::done);
    double sum = 0;
    const std::vector<float> all = pixels(folder);
    for (const float v : all) sum += double(v) / double(all.size());
    return sum;
  };
  LightSettings light;
  light.max_depth = 2;
  const double off = mean(1.999F, light, "off"), on = mean(2, light, "on");
  EXPECT_GT(on, 0);
  EXPECT_NEAR(on, off, 0.05 * off);
}

TEST_F(RunJob, LeavesItsFolderComplete) {
  JobSpec s = spec();
  s.layers = {ImageLayer::variance, ImageLayer::halves, ImageLayer::albedo, ImageLayer::normal,
              ImageLayer::depth};
  const JobFolder folder = create(s);
  EXPECT_EQ(run(folder), Outcome::done);
  EXPECT_EQ(folder.read_state().state, State::done);
  for (const char* name : {"image.exr", "image.png", "layers.half", "layers.json", "curve.csv",
                           "report.json", "progress.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;
  }
  const std::vector<float> all = pixels(folder);
  const std::vector<float> even = pixels(folder, "even");
  const std::vector<float> odd = pixels(folder, "odd");
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_NEAR(all[i], (even[i] + odd[i]) / 2, 1e-5 * std::abs(all[i]));
  EXPECT_EQ(observer.phases, (std::vector<std::string>{"loading", "rendering", "writing"}));
  EXPECT_EQ(run(folder), Outcome::done) << "a job that is done is left as it is";
}

TEST_F(RunJob, ReportSaysThatNothingWasBuiltThatNobodyNeeds) {
  const JobFolder folder = create(spec());
  run(folder);
  const json r = report(folder);
  EXPECT_TRUE(r.at("artefacts").at("built").empty());
  EXPECT_TRUE(r.at("artefacts").at("loaded").empty());
  EXPECT_EQ(r.at("scene").at("textures").at("decoded"), 0);
  EXPECT_EQ(r.at("scene").at("mask_filters"), 0);
  EXPECT_EQ(r.at("scene").at("camera"), "front");
  EXPECT_FALSE(std::filesystem::exists(temp.path() / "cache"));
  JobSpec s = spec("ajar.glb", 1);
  s.integrator = InspectSettings{InspectQuantity::normal};
  const JobFolder shape = create(s, "shape");
  run(shape);
  EXPECT_EQ(report(shape).at("scene").at("emitters"), "not needed");
  EXPECT_EQ(report(shape).at("scene").at("textures").at("decoded"), 0);
  EXPECT_GT(report(shape).at("scene").at("textures").at("in_scene"), 0);
}

TEST_F(RunJob, AutoReferenceIsMadeOnceAndKnowsItsNoise) {
  JobSpec s = spec();
  s.reference = "auto";
  s.reference_iterations = 64;
  const JobFolder first = create(s, "first");
  run(first);
  const auto references = [&] {
    std::vector<std::filesystem::path> found;
    for (const auto& e : std::filesystem::directory_iterator(temp.path() / "references"))
      found.push_back(e.path());
    return found;
  };
  ASSERT_EQ(references().size(), 1U);
  const auto written = std::filesystem::last_write_time(references()[0] / "image.exr");
  const json errors = report(first).at("errors");
  EXPECT_GT(errors.at("reference").at("own_rmse"), 0);
  EXPECT_GT(errors.at("rmse"), errors.at("reference").at("own_rmse"));
  EXPECT_FALSE(report(first).at("threads").at("sections").contains("reference"))
      << "the time of another job";
  s.seed = 2;
  run(create(s, "second"));
  EXPECT_EQ(references().size(), 1U);
  EXPECT_EQ(std::filesystem::last_write_time(references()[0] / "image.exr"), written);
  s.camera = load_gltf(std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / s.scene)
                 .cameras.at(0)
                 .name;
  run(create(s, "named"));
  EXPECT_EQ(references().size(), 1U) << "the camera that a job without a name has";
  s.camera = "front";
  s.resolution = {8, 8};
  run(create(s, "third"));
  EXPECT_EQ(references().size(), 2U);
}

TEST_F(RunJob, ACameraOfTheJobsOwnSeesWhatTheScenesCameraSees) {
  JobSpec s = spec("cornell.glb", 1);
  const JobFolder named = create(s, "named");
  run(named);
  const CameraData camera =
      load_gltf(std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes" / s.scene).cameras.at(0);
  const V3d place = camera.to_world.translation();
  const V3d at = V3d(0, 0, -1) * camera.to_world;
  s.camera = {};
  s.camera.object = CameraSettings{.position = {place.x, place.y, place.z},
                                   .target = {at.x, at.y, at.z},
                                   .fov = camera.yfov * 180 / std::numbers::pi};
  const JobFolder own = create(s, "own");
  run(own);
  // Directions may differ in their last bits: the pictures by what random numbers at an edge do.
  const std::vector<float> a = pixels(named), b = pixels(own);
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::abs(double(a[i]) - double(b[i]));
    sum += double(a[i]);
  }
  EXPECT_LT(difference, 0.01 * sum);
  s.camera.object->position[1] += 0.1;
  const JobFolder moved = create(s, "moved");
  run(moved);
  EXPECT_NE(pixels(moved), b);
}

TEST_F(RunJob, SaysWhenTheErrorEstimateIsNotKnown) {
  const auto tail_of = [&](const JobFolder& folder) {
    run(folder);
    return report(folder).at("errors").at("est_rmse_tail");
  };
  // Behind a door ajar the lamp is hit by chance: few paths carry the picture.
  JobSpec s = spec("ajar.glb", 64);
  s.camera.name = "room";
  PathSettings by_chance;
  by_chance.next_event_estimation = false;
  s.integrator = by_chance;
  const JobFolder rare = create(s, "rare");
  EXPECT_EQ(tail_of(rare).at("known"), false);
  const auto warnings = rare.read_state().warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("Pareto index"), std::string::npos);
  const JobFolder plain = create(spec("cornell.glb", 64), "plain");
  EXPECT_EQ(tail_of(plain).at("known"), true);
  EXPECT_TRUE(plain.read_state().warnings.empty());
  const JobFolder short_one = create(spec("cornell.glb", 8), "short");
  EXPECT_TRUE(tail_of(short_one).is_null()) << "8 iterations";
}

TEST_F(RunJob, CurveSaysWhenTheReferenceIsTheFloor) {
  JobSpec s = spec("cornell.glb", 512);
  s.reference = "auto";
  s.reference_iterations = 16;
  const JobFolder folder = create(s);
  run(folder);
  EXPECT_EQ(report(folder).at("errors").at("reference").at("at_floor"), true);
}

TEST_F(RunJob, StopsAtAnErrorTarget) {
  JobSpec s = spec("cornell.glb", 1);
  s.budget.iterations = 1000000;
  s.budget.error = ErrorTarget{ErrorMetric::est_rmse, 0.5};
  const JobFolder folder = create(s);
  run(folder);
  EXPECT_LE(report(folder).at("errors").at("est_rmse"), 0.5);
}

TEST_F(RunJob, NoLightIsBlackAndSaysSo) {
  const JobFolder folder = create(spec("open.glb", 1));
  EXPECT_EQ(run(folder), Outcome::done);
  for (const float v : pixels(folder)) EXPECT_EQ(v, 0);
  ASSERT_EQ(folder.read_state().warnings.size(), 1U);
  EXPECT_NE(folder.read_state().warnings[0].find("no light"), std::string::npos);
}

/// Runs a job that cannot be done; the state says why.
std::string failure(const JobFolder& folder, const RunContext& context) {
  try {
    run_job(folder, context);
  } catch (const SceneError& e) {
    EXPECT_EQ(folder.read_state().state, State::failed);
    EXPECT_EQ(folder.read_state().error, e.what());
    return e.what();
  }
  ADD_FAILURE() << "the job did not fail";
  return "";
}

TEST_F(RunJob, WhatCannotBeDoneFailsAndNamesThePlace) {
  const auto context_of = [&] { return context(never); };
  JobSpec s = spec("nowhere.glb");
  EXPECT_NE(failure(create(s, "a"), context_of()).find("nowhere.glb"), std::string::npos);
  s = spec();
  s.camera = "back";
  const std::string camera = failure(create(s, "b"), context_of());
  EXPECT_NE(camera.find("\"back\""), std::string::npos);
  EXPECT_NE(camera.find("\"front\""), std::string::npos);
  write_exr(
      temp.path() / "small.exr",
      {2, 2, {{"", {"R", "G", "B"}, std::vector<double>(12, 1)}}, PixelType::single_float, {}});
  s = spec();
  s.reference = "small.exr";
  EXPECT_NE(failure(create(s, "c"), context_of()).find("2 x 2"), std::string::npos);
  s.reference = "20260101-000000-abcdef";
  EXPECT_NE(failure(create(s, "d"), context_of()).find("no such job"), std::string::npos);
  s.reference = "../job";
  EXPECT_NE(failure(create(s, "e"), context_of()).find("../job"), std::string::npos);
  s = spec("open.glb");
  s.environment = EnvironmentSettings{"missing.hdr", 1, 0};
  EXPECT_NE(failure(create(s, "f"), context_of()).find("missing.hdr"), std::string::npos);
}

TEST_F(RunJob, AFolderIsOneProcessAtATime) {
  const JobFolder folder = create(spec());
  const auto lock = folder.try_lock();
  EXPECT_THROW(run(folder), FolderBusy);
  EXPECT_EQ(folder.read_state().state, State::queued);
}

TEST_F(RunJob, EnvironmentLightsTheScene) {
  JobSpec s = spec("open.glb", 2);
  s.environment = EnvironmentSettings{"sky.hdr", 1, 0};
  const JobFolder folder = create(s);
  run(folder);
  float largest = 0;
  for (const float v : pixels(folder)) largest = std::max(largest, v);
  EXPECT_GT(largest, 0);
  EXPECT_TRUE(folder.read_state().warnings.empty());
}

}  // namespace
}  // namespace lacuna
