#include "jobs/render/run_job.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/passing_error.h"
#include "jobs/run/reference.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/problems.h"
#include "jobs/store/inputs.h"
#include "renderer/film/preview.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/images/exr_write.h"
#include "renderer/images/image_read.h"
#include "tests/jobs/run/silent_observer.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using nlohmann::json;

/// A data root of one test, with the project's scenes and one folder more.
class RunJob : public testing::Test {
 protected:
  RunContext context(const std::function<bool()>& interrupted) {
    return {DataRoot{temp.path()},
            ScenesRoots({std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes", temp.path()}), 2,
            interrupted, observer};
  }
  JobFolder create(const JobSpec& spec, const std::string& name = "job") {
    return JobFolder::create(temp.path() / name, spec);
  }
  Outcome run(const JobFolder& folder) { return run_job(folder, context(never)); }
  Outcome run_until_asked(const JobFolder& folder, int patience) {
    std::atomic<int> asked{0};
    return run_job(folder, context([&] { return ++asked > patience; }));
  }
  /// Runs it, again and with more patience each time, until an iteration is in its checkpoint.
  /// Returns the patience that this took.
  int interrupt_with_checkpoint(const JobFolder& folder) {
    int patience = 0;
    while (folder.read_progress().value_or(Progress{}).iteration == 0) {
      EXPECT_EQ(run_until_asked(folder, ++patience), Outcome::interrupted);
    }
    return patience;
  }
  static JobSpec spec(const std::string& scene = "cornell.glb", int iterations = 4) {
    JobSpec s;
    s.scene = scene;
    s.resolution = {24, 16};
    s.budget.iterations = iterations;
    return s;
  }
  static json report(const JobFolder& folder) {
    return json::parse(read_file(folder.file("report.json"), 1 << 20));
  }
  static std::vector<float> pixels(const JobFolder& folder, const std::string& layer = "") {
    return read_float_image(folder.file("image.exr"), layer).rgb;
  }

  TemporaryFolder temp;
  SilentObserver observer;
  const std::function<bool()> never = [] { return false; };
};

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
  const auto mean = [&](float z, const IntegratorSettings& integrator, const std::string& name) {
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

TEST_F(RunJob, InterruptedAnywhereItGoesOnToTheSameBits) {
  const JobFolder whole = create(spec("ajar.glb", 12), "whole");
  run(whole);
  const JobFolder parts = create(spec("ajar.glb", 12), "parts");
  int stops = 0;
  for (int patience = 0; parts.read_state().state != State::done; patience += 2) {
    const Outcome outcome = run_until_asked(parts, patience);
    if (outcome == Outcome::interrupted) {
      ++stops;
      EXPECT_EQ(parts.read_state().state, State::interrupted);
    }
    ASSERT_LT(stops, 200);
  }
  EXPECT_GT(stops, 3);
  EXPECT_EQ(pixels(parts), pixels(whole));
  EXPECT_EQ(report(parts).at("counts").at("rays"), report(whole).at("counts").at("rays"));
}

/// Gives a job that is done a larger budget, as the service does.
void extend(const JobFolder& folder, const std::function<void(Budget&)>& grow) {
  JobSpec s = folder.read_job();
  grow(s.budget);
  write_file_atomically(folder.file("job.json"), write_job(s));
  JobState state = folder.read_state();
  state.state = State::queued;
  folder.write_state(state);
}

std::vector<std::string> lines_of(const JobFolder& folder) {
  std::istringstream text(content_of(folder.file("curve.csv")));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST_F(RunJob, DoneItGoesOnWithALargerBudgetToTheSameBits) {
  JobSpec s = spec("ajar.glb", 14);
  s.layers = {ImageLayer::variance, ImageLayer::halves};
  const JobFolder whole = create(s, "whole");
  run(whole);
  s.budget.iterations = 5;
  const JobFolder parts = create(s, "parts");
  run(parts);
  const json first = report(parts);
  const std::vector<std::string> rows = lines_of(parts);
  for (const int iterations : {6, 14}) {
    observer.milestones.clear();
    extend(parts, [&](Budget& b) { b.iterations = iterations; });
    EXPECT_EQ(run(parts), Outcome::done);
    EXPECT_EQ(observer.milestones.front().rfind("continuing from iteration ", 0), 0U);
    for (const std::string& w : observer.warnings)
      EXPECT_EQ(w.find("checkpoint"), std::string::npos) << w;
  }
  for (const char* layer : {"", "variance", "even", "odd"}) {
    EXPECT_EQ(pixels(parts, layer), pixels(whole, layer)) << layer;
  }
  const json last = report(parts);
  EXPECT_EQ(last.at("counts"), report(whole).at("counts"));
  for (const auto& [phase, seconds] : first.at("seconds").items()) {
    if (phase == "write" || phase == "checkpoint" || phase == "progress") continue;  // ends later
    EXPECT_GE(last.at("seconds").at(phase), seconds) << phase;
  }
  EXPECT_GT(last.at("seconds").at("load"), first.at("seconds").at("load")) << "loaded three times";
  const std::vector<std::string> more = lines_of(parts);
  ASSERT_GT(more.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(more[i], rows[i]) << "row " << i;
  EXPECT_EQ(more.back().substr(0, 3), "14,");
}

TEST_F(RunJob, ABudgetOfTimeGoesOnFromWhereItEnded) {
  JobSpec s = spec();
  s.budget = {};
  s.budget.seconds = 0.05;
  const JobFolder folder = create(s);
  run(folder);
  const std::int64_t before = report(folder).at("counts").at("iterations");
  extend(folder, [](Budget& b) { b.seconds = 0.2; });
  run(folder);
  EXPECT_GT(report(folder).at("counts").at("iterations"), before);
  EXPECT_GT(report(folder).at("seconds").at("render"), 0.05);
  EXPECT_EQ(folder.read_progress()->iteration, report(folder).at("counts").at("iterations"));
}

TEST_F(RunJob, KilledWhileItsResultsAreWrittenItRendersNothingAnew) {
  const JobFolder folder = create(spec());
  run(folder);
  const auto checkpoint = std::filesystem::last_write_time(folder.file("checkpoint.bin"));
  const json counts = report(folder).at("counts");
  std::filesystem::remove(folder.file("image.exr"));
  extend(folder, [](Budget&) {});
  EXPECT_EQ(run(folder), Outcome::done);
  EXPECT_EQ(report(folder).at("counts"), counts);
  EXPECT_TRUE(std::filesystem::exists(folder.file("image.exr")));
  EXPECT_EQ(std::filesystem::last_write_time(folder.file("checkpoint.bin")), checkpoint);
}

TEST_F(RunJob, InterruptedItsProgressIsThatOfItsCheckpoint) {
  const JobFolder folder = create(spec("cornell.glb", 1000000));
  const int patience = interrupt_with_checkpoint(folder);
  const auto progress = folder.read_progress();
  ASSERT_TRUE(progress);
  EXPECT_GT(progress->iteration, 0);
  observer.milestones.clear();
  ASSERT_EQ(run_until_asked(folder, patience), Outcome::interrupted);
  ASSERT_FALSE(observer.milestones.empty());
  const std::string said = observer.milestones.front();
  EXPECT_EQ(said.rfind("continuing from iteration " + std::to_string(progress->iteration) + " ", 0),
            0U)
      << said;
  EXPECT_GE(folder.read_progress()->iteration, progress->iteration);
}

TEST_F(RunJob, AFolderThatCannotBeWrittenLeavesTheJobAsItIs) {
  const JobFolder folder = create(spec("cornell.glb", 1000000));
  interrupt_with_checkpoint(folder);
  const std::string checkpoint = content_of(folder.file("checkpoint.bin"));
  // A limit on the size of files stands for a full disk.
  JobSpec s = folder.read_job();
  s.budget.iterations = folder.read_progress()->iteration + 1;
  write_file_atomically(folder.file("job.json"), write_job(s));
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, limit.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(run(folder), std::system_error);
  ::setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_EQ(folder.read_state().state, State::interrupted);
  EXPECT_NE(folder.read_state().error.find("cannot write"), std::string::npos);
  EXPECT_EQ(content_of(folder.file("checkpoint.bin")), checkpoint);
  for (const std::string& name : names_in(folder.dir())) {
    EXPECT_FALSE(name.ends_with(".tmp")) << name;
  }
  EXPECT_EQ(run(folder), Outcome::done);
  EXPECT_EQ(folder.read_state().error, "");
}

TEST_F(RunJob, StoppedWithoutTimeToWriteItSaysSoAndGoesOn) {
  const JobFolder whole = create(spec("ajar.glb", 12), "whole");
  run(whole);
  const JobFolder folder = create(spec("ajar.glb", 12));
  const int patience = interrupt_with_checkpoint(folder);
  const std::string checkpoint = content_of(folder.file("checkpoint.bin"));
  JobState state;
  for (int more = patience; state.warnings.empty(); ++more) {
    std::atomic<int> asked{0};
    const std::function<bool()> interrupted = [&] { return ++asked > more; };
    RunContext late = context(interrupted);
    late.seconds_left = [] { return 0.0; };
    ASSERT_EQ(run_job(folder, late), Outcome::interrupted);
    state = folder.read_state();
    EXPECT_EQ(state.state, State::interrupted);
    EXPECT_EQ(state.error, "");
  }
  EXPECT_NE(state.warnings[0].find("before a checkpoint could be written"), std::string::npos);
  EXPECT_EQ(content_of(folder.file("checkpoint.bin")), checkpoint);
  EXPECT_EQ(run(folder), Outcome::done);
  EXPECT_EQ(pixels(folder), pixels(whole));
  EXPECT_EQ(folder.read_state().warnings, whole.read_state().warnings);
}

TEST_F(RunJob, StoppedWhileItWritesItsResultsItWritesThemAnotherTime) {
  JobSpec s = spec();
  s.layers = {ImageLayer::variance, ImageLayer::halves};
  const JobFolder whole = create(s, "whole"), folder = create(s);
  run(whole);
  const std::function<bool()> writing = [&] {
    return !observer.phases.empty() && observer.phases.back() == "writing";
  };
  observer.phases.clear();
  RunContext late = context(writing);
  late.seconds_left = [] { return 0.0; };
  EXPECT_EQ(run_job(folder, late), Outcome::interrupted);
  EXPECT_EQ(folder.read_state().state, State::interrupted);
  EXPECT_FALSE(std::filesystem::exists(folder.file("image.exr")));
  EXPECT_EQ(run(folder), Outcome::done);
  EXPECT_EQ(pixels(folder), pixels(whole));
}

TEST_F(RunJob, DamagedCheckpointIsReportedKeptAndDoneWithout) {
  const JobFolder whole = create(spec("cornell.glb", 6), "whole");
  run(whole);
  const JobFolder folder = create(spec("cornell.glb", 6));
  interrupt_with_checkpoint(folder);
  std::string bytes = read_file(folder.file("checkpoint.bin"), 1 << 24);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write_file_atomically(folder.file("checkpoint.bin"), bytes);
  EXPECT_EQ(run(folder), Outcome::done);
  ASSERT_FALSE(observer.warnings.empty());
  EXPECT_NE(observer.warnings.back().find("checksum"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder.file("checkpoint.unusable")));
  EXPECT_EQ(pixels(folder), pixels(whole));
}

TEST_F(RunJob, CheckpointOfAnotherSceneIsNotGoneOnFrom) {
  const auto scenes = std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/scenes";
  const JobFolder whole = create(spec("cornell.glb", 6), "whole");
  run(whole);
  std::filesystem::copy_file(scenes / "ajar.glb", temp.path() / "own.glb");
  const JobFolder folder = create(spec("own.glb", 6));
  interrupt_with_checkpoint(folder);
  std::filesystem::copy_file(scenes / "cornell.glb", temp.path() / "own.glb",
                             std::filesystem::copy_options::overwrite_existing);
  const std::string checkpoint = content_of(folder.file("checkpoint.bin"));
  const std::string said = message_of<BadJob>([&] { run(folder); });
  EXPECT_TRUE(contains(said, "scene \"own.glb\" has ") && contains(said, "--again")) << said;
  EXPECT_EQ(folder.read_state().error, said);
  EXPECT_EQ(content_of(folder.file("checkpoint.bin")), checkpoint);
  // What an older build left does not say what it was made from; its checkpoint still does.
  std::filesystem::remove(folder.file("inputs.json"));
  EXPECT_EQ(run(folder), Outcome::done);
  ASSERT_EQ(observer.warnings.size(), 2U);
  EXPECT_TRUE(contains(observer.warnings[0], "did not record its inputs"));
  EXPECT_TRUE(contains(observer.warnings[1], "another picture"));
  EXPECT_EQ(pixels(folder), pixels(whole));
  EXPECT_TRUE(std::filesystem::exists(folder.file("inputs.json")));
}

/// A scene of several files under a sky, and a reference.
class ChangedInputs : public RunJob {
 protected:
  void SetUp() override {
    namespace fs = std::filesystem;
    fs::create_directory(temp.path() / "room");
    test::GlbBuilder scene;
    scene.json["images"] = json::array({{{"uri", "a%20b.png"}}});
    scene.json["textures"] = json::array({{{"source", 0}}});
    const auto material = scene.add_material(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}});
    scene.add_node({{"mesh", scene.add_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, int(material))}});
    scene.add_camera("front", {0, 0, 3}, 0.6);
    temp.write("room/room.gltf", scene.gltf("room.bin"));
    temp.write("room/room.bin", scene.bin);
    write_preview(temp / "room/a b.png", 2, 1, std::vector<double>(6, 0.5));
    for (const char* name : {"sky.exr", "ref.exr"}) write_picture(name, 8, 1);
    job = spec("room/room.gltf", 2);
    job.resolution = {8, 8};
    job.environment = EnvironmentSettings{"sky.exr", 1, 0};
    job.reference = "ref.exr";
  }
  void write_picture(const char* name, int side, double value) {
    const auto n = 3 * std::size_t(side) * std::size_t(side);
    write_exr(temp / name, {side,
                            side,
                            {{"", {"R", "G", "B"}, std::vector<double>(n, value)}},
                            PixelType::single_float,
                            {}});
  }
  /// Changes each of the files, and what it is called then.
  std::vector<std::pair<std::string, std::function<void()>>> changes() {
    return {{"scene \"room/room.gltf\" has ",
             [&] { temp.write("room/room.gltf", content_of(temp / "room/room.gltf") + " "); }},
            {"buffer \"room.bin\" has another content of the same size",
             [&] {
               std::string bytes = content_of(temp / "room/room.bin");
               bytes[3] = static_cast<char>(bytes[3] ^ 0x10);
               temp.write("room/room.bin", bytes);
             }},
            {"texture \"a%20b.png\" has ",
             [&] {
               write_preview(temp / "room/a b.png", 2, 1, std::vector<double>{1, 1, 1, 0, 0, 0});
             }},
            {"environment \"sky.exr\" has ", [&] { write_picture("sky.exr", 8, 2); }},
            {"reference \"ref.exr\" has ", [&] { write_picture("ref.exr", 8, 2); }}};
  }

  JobSpec job;
};

TEST_F(ChangedInputs, AreNamedAndWhatWasMadeStays) {
  namespace fs = std::filesystem;
  const JobFolder done = create(job, "done");
  run(done);
  const std::string picture = content_of(done.file("image.exr"));
  JobSpec longer = job;
  longer.budget.iterations = 1000000;
  const JobFolder begun = create(longer, "begun");
  interrupt_with_checkpoint(begun);
  const auto files = {"room/room.gltf", "room/room.bin", "room/a b.png", "sky.exr", "ref.exr"};
  for (const char* file : files) {  // a new date is no change
    fs::last_write_time(temp / file, fs::last_write_time(temp / file) + std::chrono::hours(1));
  }
  EXPECT_EQ(run(done), Outcome::done);
  EXPECT_EQ(read_inputs(done)->size(), files.size());
  const auto keep = [&](const fs::path& from, const fs::path& to) {
    fs::create_directories(to / "room");
    for (const char* file : files) {
      fs::copy_file(from / file, to / file, fs::copy_options::overwrite_existing);
    }
  };
  keep(temp.path(), temp / "kept");
  for (const auto& [name, change] : changes()) {
    SCOPED_TRACE(name);
    change();
    EXPECT_TRUE(contains(message_of<BadJob>([&] { run(done); }), name));
    EXPECT_TRUE(contains(message_of<BadJob>([&] { run(begun); }), name));
    keep(temp / "kept", temp.path());
  }
  EXPECT_EQ(run(done), Outcome::done);
  EXPECT_EQ(content_of(done.file("image.exr")), picture);
  fs::remove(temp / "room/a b.png");
  EXPECT_TRUE(contains(message_of<BadJob>([&] { run(done); }),
                       "texture \"a%20b.png\" is not there any more"));
  fs::remove(done.file("inputs.json"));
  EXPECT_EQ(run(done), Outcome::done);
  EXPECT_TRUE(contains(observer.warnings.back(), "did not record its inputs"));
}

TEST_F(ChangedInputs, WhatCannotBeReadNowIsNoFaultOfTheJob) {
  namespace fs = std::filesystem;
  const ScenesRoots share({temp / "share"});
  const RunContext away{DataRoot{temp.path()}, share, 2, never, observer};
  job.scene = "room.gltf";
  job.environment.reset();
  job.reference.clear();
  const JobFolder folder = create(job);
  EXPECT_THROW(run_job(folder, away), InputUnreadable);
  fs::create_directory(temp / "share");
  EXPECT_THROW(run_job(folder, away), InputUnreadable);
  EXPECT_EQ(folder.read_state().state, State::interrupted);
  EXPECT_TRUE(contains(folder.read_state().error, "its folder is empty"));
  put_file(temp / "share/other", "");
  EXPECT_THROW(run_job(folder, away), SceneError);
  EXPECT_EQ(folder.read_state().state, State::failed);
  for (const char* file : {"room.gltf", "room.bin", "a b.png"}) {
    fs::copy_file(temp / "room" / file, temp / "share" / file);
  }
  EXPECT_EQ(run_job(folder, away), Outcome::done);
  fs::rename(temp / "share", temp / "away");
  EXPECT_THROW(run_job(folder, away), InputUnreadable) << "whether it has changed is not known";
  EXPECT_EQ(folder.read_state().state, State::done);
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
  EXPECT_NE(warnings[0].find("tail of index"), std::string::npos);
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
