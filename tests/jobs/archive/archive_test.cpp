#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "base/storage/atomic_file.h"
#include "jobs/archive/check_archive.h"
#include "jobs/archive/pack_sweep.h"
#include "jobs/archive/tar_zstd.h"
#include "jobs/spec/problems.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

/// A sweep of two cells with two seeds each over a scene of two files. Its runs are made up.
class Archive : public testing::Test {
 protected:
  Archive() {
    fs::create_directories(temp.path() / "root/room");
    temp.write("root/room/a.glb", "scene");
    temp.write("root/room/wall.png", "texture");
    temp.write("root/truth.exr", "reference");
  }
  SweepFolder sweep(const std::string& name, double factor) {
    SweepFolder s = SweepFolder::create(temp.path() / name, parse_sweep(R"({"seeds": 2,
      "job": {"scene": "room/a.glb", "reference": "truth.exr", "integrator": "path"},
      "axes": {"/integrator/max_depth": [2, 4]}})"));
    for (const SweepRun& run : s.plan().runs) {
      const JobFolder folder = JobFolder::create(s.folder(run).dir(), s.plan().job_of(run));
      const double error = factor * (1 + .01 * run.replicate);
      write_file_atomically(
          folder.file("curve.csv"),
          fmt::format("iteration,seconds,cpu_seconds,mae,rmse,mse,relmse,smape,est_rmse,at_floor\n"
                      "8,2,1.5,1,1,1,{},1,1,0\n",
                      error));
      write_file_atomically(folder.file("report.json"), "{}");
      write_file_atomically(folder.file("image.exr"), run.name);
      write_inputs(folder, {measured(InputRole::scene, "room/a.glb", "room/a.glb"),
                            measured(InputRole::texture, "wall.png", "room/wall.png"),
                            measured(InputRole::reference, "truth.exr", "truth.exr")});
      JobState state = folder.read_state();
      state.state = State::done;
      folder.write_state(state);
    }
    return s;
  }
  InputFile measured(InputRole role, const std::string& name, const std::string& file) const {
    InputFile input = measure_input(temp.path() / "root" / file);
    input.role = role;
    input.name = name;
    return input;
  }
  PackSummary pack(const SweepFolder& s, const PackOptions& options = {}) const {
    return pack_sweep(s, data, scenes, options, temp.path() / "x.tar.zst");
  }
  ArchiveCheck check(const std::optional<SweepFolder>& against = {}) const {
    InputCheck inputs(data, scenes);
    return check_archive(temp.path() / "x.tar.zst", inputs, against);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    read_tar(temp.path() / "x.tar.zst", [&](TarEntry& e) { all.push_back(e.name()); });
    return all;
  }
  /// Extracts the archive below `un`, as tar does.
  void extract() const {
    read_tar(temp.path() / "x.tar.zst", [&](TarEntry& e) {
      fs::create_directories((temp.path() / "un" / e.name()).parent_path());
      std::ofstream(temp.path() / "un" / e.name()) << e.text(1 << 20);
    });
  }

  TemporaryFolder temp;
  DataRoot data{temp.path() / "data"};
  ScenesRoots scenes{{temp.path() / "root"}};
};

TEST_F(Archive, HasAllThatRepeatsTheSweep) {
  const PackSummary summary = pack(sweep("s", 1));
  EXPECT_EQ(summary.runs, 4u);
  EXPECT_TRUE(summary.warnings.empty());
  const auto all = names();
  for (const char* name :
       {"sweep.json", "runs/0001-1/job.json", "runs/0002-2/image.exr", "scenes/room/a.glb",
        "scenes/room/wall.png", "scenes/truth.exr", "manifest.json", "reproduce.sh"}) {
    EXPECT_EQ(std::count(all.begin(), all.end(), std::string("x/") + name), 1) << name;
  }
  const ArchiveCheck c = check();
  EXPECT_EQ(c.runs, 4u);
  EXPECT_EQ(c.files, all.size() - 2);
  EXPECT_EQ(c.differences, std::vector<std::string>{});
}

TEST_F(Archive, OfWhatIsLeftOutTheHashIsCompared) {
  PackOptions options;
  options.leave_out = {"room/*"};
  options.pictures = false;
  EXPECT_EQ(pack(sweep("s", 1), options).left_out, 2u);
  for (const std::string& name : names()) {
    EXPECT_EQ(name.find("room"), std::string::npos) << name;
    EXPECT_EQ(name.find("image.exr"), std::string::npos) << name;
  }
  EXPECT_TRUE(check().differences.empty());
  temp.write("root/room/wall.png", "TEXTURE");
  EXPECT_EQ(check().differences,
            (std::vector<std::string>{
                "texture \"wall.png\" is left out, and that of the scenes root differs"}));
}

TEST_F(Archive, FindsWhatChangedAfterExtraction) {
  pack(sweep("s", 1));
  extract();
  const fs::path x = temp.path() / "un/x";
  InputCheck inputs(data, scenes);
  EXPECT_TRUE(check_archive(x / "manifest.json", inputs, {}).differences.empty());
  std::ofstream(x / "runs/0001-1/curve.csv", std::ios::app) << "9,9\n";
  fs::remove(x / "scenes/truth.exr");
  EXPECT_EQ(check_archive(x / "manifest.json", inputs, {}).differences,
            (std::vector<std::string>{"runs/0001-1/curve.csv is not the file that was archived",
                                      "scenes/truth.exr is missing"}));
}

TEST_F(Archive, ComparesErrorsByTheirIntervals) {
  pack(sweep("s", 1));
  const ArchiveCheck same = check(sweep("same", 1.005));
  EXPECT_TRUE(same.differences.empty());
  EXPECT_EQ(same.notes.size(), 2u);
  const ArchiveCheck other = check(sweep("other", 2));
  ASSERT_EQ(other.differences.size(), 2u);
  EXPECT_EQ(other.differences[0].find("max_depth 2: relmse is 2 of the archived [1."), 0u)
      << other.differences[0];
}

TEST_F(Archive, RefusesChangedInputsAndSweepsWithoutResults) {
  const SweepFolder s = sweep("s", 1);
  temp.write("root/room/wall.png", "TEXTURE");
  EXPECT_THROW(pack(s), BadJob);
  EXPECT_FALSE(fs::exists(temp.path() / "x.tar.zst"));
  EXPECT_FALSE(fs::exists(temp.path() / "x.tar.zst.part"));
  const SweepFolder empty = SweepFolder::create(temp.path() / "empty",
                                                parse_sweep(R"({"job": {"scene": "room/a.glb"}})"));
  EXPECT_THROW(pack(empty), BadJob);
}

TEST_F(Archive, DamagedOnesAreRefused) {
  const fs::path file = temp.path() / "x.tar.zst";
  temp.write("x.tar.zst", "no tar at all");
  EXPECT_THROW(check(), std::runtime_error);
  pack(sweep("s", 1));
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_THROW(check(), std::runtime_error);
  TarWriter tar(file);
  tar.add_text("x/other.txt", "text");
  tar.finish();
  EXPECT_THROW(check(), std::runtime_error);
  TarWriter bad(file);
  bad.add_text("x/manifest.json", R"({"version": 3})");
  bad.finish();
  EXPECT_THROW(check(), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
