// A job whose scene, textures, environment or reference have changed.

#include "base/storage/passing_error.h"
#include "jobs/spec/problems.h"
#include "jobs/store/inputs.h"
#include "renderer/film/preview.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/images/exr_write.h"
#include "tests/jobs/run/run_job_fixture.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using nlohmann::json;
using test::RunJob;

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
            {"buffer \"room.bin\" has changed contents of the same size",
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
  EXPECT_TRUE(
      contains(message_of<BadJob>([&] { run(done); }), "texture \"a%20b.png\" no longer exists"));
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
  EXPECT_TRUE(contains(folder.read_state().error, "is missing or empty"));
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

}  // namespace
}  // namespace lacuna
