// The integrator `auto`: its candidates are jobs, its decisions are kept, and its picture is that
// of the method that it chose.

#include "jobs/run/choosing.h"

#include <cmath>

#include "jobs/run/advise.h"
#include "tests/jobs/run/run_job_fixture.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using test::json;

class Choose : public test::RunJob {
 protected:
  static JobSpec choosing(std::vector<CandidateSettings> among, int iterations = 40) {
    AutoSettings s;
    s.max_depth = 4;
    s.candidates = std::move(among);
    JobSpec job = spec("ajar.glb", iterations);
    job.camera.name = "room";
    job.integrator = s;
    return job;
  }
  static std::vector<CandidateSettings> three() {
    MetropolisSettings chains;
    chains.chains = 20;
    return {PathSettings{}, chains, BdptSettings{}};
  }
  static Choice choice_in(const JobFolder& folder) { return *read_choice(folder); }
};

class LongChoose : public Choose {};

TEST_F(Choose, ThePictureIsThatOfTheChosenMethod) {
  const JobSpec job = choosing(three());
  const JobFolder folder = create(job);
  ASSERT_EQ(run(folder), Outcome::done);
  const Choice choice = choice_in(folder);
  ASSERT_TRUE(choice.chosen);
  const JobFolder plain = create(*chosen_job(job, choice), "plain");
  ASSERT_EQ(run(plain), Outcome::done);
  EXPECT_EQ(pixels(folder), pixels(plain));
  EXPECT_EQ(report(folder)["counts"]["iterations"], 40);
  EXPECT_EQ(report(folder)["choice"]["candidates"].size(), 3U);
}

TEST_F(Choose, CandidatesAreJobsInFoldersOfTheirOwn) {
  const JobFolder folder = create(choosing(three()));
  ASSERT_EQ(run(folder), Outcome::done);
  const Choice choice = choice_in(folder);
  for (std::size_t k = 0; k < 3; ++k) {
    const JobFolder own = candidate_folder(folder, choice, k);
    EXPECT_TRUE(fs::exists(own.file("curve.csv"))) << own.dir();
    EXPECT_FALSE(fs::exists(own.file("checkpoint.bin"))) << "nothing will go on from it";
    EXPECT_EQ(own.read_job(), candidate_job(folder.read_job(), choice.candidates[k]));
    EXPECT_EQ(choice.candidates[k].left.empty(), choice.chosen == int(k));
  }
  EXPECT_EQ(choice.candidates[0].turns.front().iterations,
            choice.candidates[2].turns.front().iterations);
}

// Budgets without a time count rays, so that decisions do not depend on clocks.
TEST_F(Choose, DecisionsAndBitsAreTheSameForAnyThreadsAndInterruptions) {
  const JobSpec job = choosing(three());
  const JobFolder straight = create(job, "straight");
  ASSERT_EQ(run(straight), Outcome::done);
  const JobFolder stopped = create(job, "stopped");
  int stops = 0;
  std::vector<std::string> decided;
  for (int patience = 4;; patience += patience / 3 + 1) {
    std::atomic<int> asked{0};
    const std::function<bool()> impatient = [&] { return ++asked > patience; };
    RunContext context = this->context(impatient);
    context.threads = 1;
    const Outcome outcome = run_job(stopped, context);
    if (const auto choice = read_choice(stopped)) {
      for (std::size_t i = 0; i < decided.size(); ++i) {
        if (!decided[i].empty()) {
          EXPECT_EQ(choice->candidates[i].left, decided[i]);
        }
      }
      decided.clear();
      for (const Candidate& c : choice->candidates) decided.push_back(c.left);
    }
    if (outcome == Outcome::done) break;
    ++stops;
  }
  EXPECT_GE(stops, 5);
  EXPECT_EQ(pixels(stopped), pixels(straight));
  const Choice a = choice_in(straight), b = choice_in(stopped);
  EXPECT_EQ(a.chosen, b.chosen);
  for (std::size_t k = 0; k < a.candidates.size(); ++k) {
    ASSERT_EQ(a.candidates[k].turns.size(), b.candidates[k].turns.size());
    for (std::size_t i = 0; i < a.candidates[k].turns.size(); ++i) {
      EXPECT_EQ(a.candidates[k].turns[i].noise, b.candidates[k].turns[i].noise);
      EXPECT_EQ(a.candidates[k].turns[i].rays, b.candidates[k].turns[i].rays);
    }
  }
}

TEST_F(Choose, AMethodThatMissesTheLightIsNotChosen) {
  PathSettings blind;
  blind.next_event_estimation = false;
  JobSpec job = choosing({blind, PathSettings{}, BdptSettings{}}, 160);
  job.scene = "cornell.glb";
  job.camera.name.clear();
  const JobFolder folder = create(job);
  ASSERT_EQ(run(folder), Outcome::done);
  EXPECT_NE(choice_in(folder).chosen, 0);
}

// The picture holds the iterations that it was chosen by, and a method whose bright paths are
// missing looks better than it is. What that costs stays below the noise of a picture.
TEST_F(LongChoose, HardlyDarkensThePicture) {
  PathSettings blind;
  blind.next_event_estimation = false;
  const auto brightness = [&](const JobSpec& job, const std::string& name) {
    const JobFolder folder = create(job, name);
    EXPECT_EQ(run(folder), Outcome::done);
    double sum = 0;
    const std::vector<float> all = pixels(folder);
    for (const float v : all) sum += double(v) / double(all.size());
    return sum;
  };
  statistics::Moments found, expected;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    JobSpec job = choosing({PathSettings{}, blind, BdptSettings{}}, 12);
    job.scene = "cornell.glb";
    job.camera.name.clear();
    job.resolution = {12, 8};
    job.seed = seed;
    found.add(brightness(job, "chosen" + std::to_string(seed)));
    job.integrator = BdptSettings{};
    std::get<BdptSettings>(job.integrator).max_depth = 4;
    job.seed = 1000 + seed;
    expected.add(brightness(job, "plain" + std::to_string(seed)));
  }
  const double ratio = found.mean() / expected.mean();
  RecordProperty("ratio", std::to_string(ratio));
  EXPECT_NEAR(ratio, 1,
              0.02 + 3 * (found.standard_error() + expected.standard_error()) / expected.mean());
}

// The only one left has an iteration, however long that takes.
TEST_F(LongChoose, TheFirstThatRendersMayBeLate) {
  ImportanceCacheSettings records;
  records.light_paths = 1 << 16;
  records.record_density = 0.1;
  BdptSettings large;
  large.connections = records;
  JobSpec job = choosing({large, PathSettings{}});
  job.resolution = {2048, 1536};
  job.budget = {};
  job.budget.cpu_seconds = 1e-6;
  const JobFolder folder = create(job);
  ASSERT_EQ(run(folder), Outcome::done);
  const Choice choice = choice_in(folder);
  EXPECT_NE(choice.candidates[0].left.find("MiB"), std::string::npos) << choice.candidates[0].left;
  EXPECT_EQ(choice.chosen, 1);
}

TEST_F(Choose, OneCandidateNeedsNoTurns) {
  const JobFolder folder = create(choosing({BdptSettings{}}, 6));
  ASSERT_EQ(run(folder), Outcome::done);
  EXPECT_FALSE(fs::exists(folder.file("candidates")));
  EXPECT_EQ(report(folder)["counts"]["iterations"], 6);
}

TEST_F(Choose, TimeOfAllCandidatesCounts) {
  JobSpec job = choosing(three());
  job.budget = {};
  job.budget.cpu_seconds = 0.6;
  const JobFolder folder = create(job);
  ASSERT_EQ(run(folder), Outcome::done);
  const json end = report(folder);
  EXPECT_LE(end["seconds"]["render_cpu"].get<double>(), 0.6);
  const Choice choice = choice_in(folder);
  const auto& own = choice.candidates[std::size_t(*choice.chosen)].turns.back();
  const Spent others = spent_elsewhere(choice);
  EXPECT_GT(others.cpu_seconds, 0);
  EXPECT_GT(end["seconds"]["render_cpu"].get<double>(), others.cpu_seconds + own.cpu_seconds);
  const std::string curve = read_file(folder.file("curve.csv"), 1 << 20);
  EXPECT_EQ(curve.find("\n0,"), std::string::npos);
}

TEST_F(Choose, WithoutLightAllIsBlack) {
  MetropolisSettings chains;
  JobSpec job = choosing({chains, PathSettings{}});
  // Nothing emits: chains have nowhere to begin, and all pictures are black.
  job.scene = "open.glb";
  job.camera.name.clear();
  const JobFolder folder = create(job);
  ASSERT_EQ(run(folder), Outcome::done);
  for (const float v : pixels(folder)) EXPECT_EQ(v, 0);
}

TEST_F(Choose, AdviceStopsAtTheChoiceAndAJobGoesOnFromIt) {
  const JobFolder folder = create(choosing(three()));
  const RunContext context = this->context(never);
  const Choice choice = advise(folder, context);
  ASSERT_TRUE(choice.chosen);
  EXPECT_FALSE(fs::exists(folder.file("image.exr")));
  ASSERT_EQ(run(folder), Outcome::done);
  EXPECT_EQ(choice_in(folder), choice);
}

TEST_F(Choose, ADamagedRecordIsKeptAside) {
  const JobFolder folder = create(choosing(three()));
  write_file_atomically(folder.file("choice.json"), "{\"chosen\": 7");
  ASSERT_EQ(run(folder), Outcome::done);
  EXPECT_TRUE(fs::exists(folder.file("choice.unusable")));
  ASSERT_FALSE(observer.warnings.empty());
  EXPECT_NE(observer.warnings.front().find("choosing again"), std::string::npos);
}

TEST(ShareOfTurns, DoublesAndAddsUp) {
  for (std::size_t all = 2; all < 12; ++all) {
    double sum = 0, before = 0;
    int round = 0;
    for (std::size_t n = all; n > 1; n = (n + 1) / 2, ++round) {
      const double now = share_of_turns(all, round);
      if (round > 0) {
        EXPECT_DOUBLE_EQ(now, 2 * before);
      }
      sum += double(n) * (now - before);
      before = now;
    }
    EXPECT_NEAR(sum, choosing_share, 1e-12) << all;
  }
}

}  // namespace
}  // namespace lacuna
