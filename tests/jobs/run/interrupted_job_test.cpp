// Jobs that are stopped, extended, or whose checkpoint is damaged.

#include <sys/resource.h>

#include <csignal>
#include <sstream>
#include <system_error>

#include "jobs/spec/job_json.h"
#include "jobs/spec/problems.h"
#include "tests/jobs/run/run_job_fixture.h"

namespace lacuna {
namespace {

using nlohmann::json;
using test::RunJob;

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

}  // namespace
}  // namespace lacuna
