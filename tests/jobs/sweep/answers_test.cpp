#include "jobs/sweep/answers.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

/// What a test's run leaves: an error of c / t at 1, 2, 4 and 8 s.
struct FakeRun {
  double c = 1;
  std::string report = R"({"seconds": {"load": 0.5, "analysis": 0}, "artefacts": {"built": [],
    "loaded": [], "left_out": []}, "errors": {"reference": {"own_rmse": 0.1}}})";
  bool at_floor = false;
};

class SweepAnswers : public testing::Test {
 protected:
  SweepFolder make(const std::string& sweep) {
    return SweepFolder::create(temp.path() / "sweep", parse_sweep(sweep));
  }
  static void finish(const SweepFolder& sweep, std::size_t run, const FakeRun& fake) {
    const SweepRun& made = sweep.plan().runs[run];
    const JobFolder folder = JobFolder::create(sweep.folder(made).dir(), sweep.plan().job_of(made));
    std::string curve =
        "iteration,seconds,cpu_seconds,samples,rays,shadow_rays,mae,rmse,mse,relmse,smape,est_rmse,"
        "negative,rejected,at_floor\n";
    for (const int t : {1, 2, 4, 8}) {
      const double e = fake.c / t;
      curve += fmt::format("{},{},{},1,1,1,{},{},{},{},{},{},0,0,{}\n", 10 * t, t, 0.5 * t, e, e, e,
                           e, e, std::sqrt(e / 2), fake.at_floor && t == 8 ? 1 : 0);
    }
    write_file_atomically(folder.file("curve.csv"), curve, false);
    write_file_atomically(folder.file("report.json"), fake.report, false);
    JobState state = folder.read_state();
    state.state = State::done;
    folder.write_state(state);
  }
  static SweepFolder finish_all(SweepFolder sweep, const std::vector<FakeRun>& runs) {
    for (std::size_t i = 0; i < runs.size(); ++i) finish(sweep, i, runs[i]);
    return sweep;
  }
  TemporaryFolder temp;
};

constexpr const char* two_depths = R"({"seeds": 2, "baseline": {"/integrator/max_depth": 2},
  "job": {"scene": "a.glb", "reference": "r.exr", "integrator": "path", "budget": {"iterations": 80}},
  "axes": {"/integrator/max_depth": [2, 4]}, "compare_at": {"seconds": [4], "errors": [0.5, 0.01]}})";

// An iteration that the end of the budget cut off left no row.
TEST_F(SweepAnswers, TheLastRowCountsUntilTheBudgetEnds) {
  for (const auto& [budget, counts] :
       std::vector<std::pair<std::string, bool>>{{R"({"seconds": 10})", true},
                                                 {R"({"seconds": 10, "iterations": 80})", false},
                                                 {R"({"cpu_seconds": 10})", false}}) {
    SCOPED_TRACE(budget);
    const TemporaryFolder own;
    const SweepFolder sweep = SweepFolder::create(
        own.path() / "sweep",
        parse_sweep(R"({"job": {"scene": "a.glb", "reference": "r.exr", "budget": )" + budget +
                    R"(}, "compare_at": {"seconds": [10]}})"));
    const Answers a = answer(finish_all(sweep, {{16}}));
    ASSERT_EQ(a.cells[0].at.size(), 1u);
    EXPECT_EQ(a.cells[0].at[0].error.has_value(), counts);
    if (counts) {
      EXPECT_NEAR(a.cells[0].at[0].error->value, 2, 1e-9);
    }
  }
}

// A picture of another program at 4.2 s, whose squared error is taken to be as 1 / time near it.
TEST_F(SweepAnswers, AnotherProgramIsComparedNearItsTimeOnly) {
  const SweepFolder sweep = make(R"({"job": {"scene": "a.glb", "reference": "r.exr"},
    "axes": {"/integrator": ["path", {"type": "foreign", "name": "Other",
      "pictures": [{"file": "o.exr", "seconds": 4.2}]}]},
    "compare_at": {"seconds": [2, 4], "metric": "mse"}})");
  finish_all(sweep, {{16}, {16}});
  const JobFolder other = sweep.folder(sweep.plan().runs[1]);
  write_file_atomically(
      other.file("curve.csv"),
      "iteration,seconds,cpu_seconds,mae,rmse,mse,relmse,smape,est_rmse,at_floor\n"
      ",4.2,,1,1,3,1,1,,0\n");
  write_file_atomically(other.file("report.json"), R"({"seconds": {"render": 4.2}})");
  const Answers a = answer(sweep);
  EXPECT_EQ(cell_text(sweep.plan().cells[1].settings), "integrator Other");
  EXPECT_FALSE(a.cells[1].at[0].error);
  ASSERT_TRUE(a.cells[1].at[1].error);
  EXPECT_NEAR(a.cells[1].at[1].error->value, 3 * 4.2 / 4, 1e-9);
  EXPECT_FALSE(a.cells[1].preparation.cold || a.cells[1].preparation.warm);
  EXPECT_FALSE(a.cells[1].variance);
  ASSERT_TRUE(a.cells[1].efficiency);
  EXPECT_NEAR(a.cells[1].efficiency->value, 1 / (3 * 4.2), 1e-9);
}

TEST_F(SweepAnswers, HowManySeedsWouldHalveWideIntervals) {
  const SweepFolder sweep = finish_all(make(two_depths), {{16}, {4}, {16}, {1}});
  const Answers wide = answer(sweep);
  ASSERT_EQ(wide.warnings.size(), 1u);
  EXPECT_TRUE(wide.warnings[0].starts_with("2 seeds: intervals of errors span"))
      << wide.warnings[0];
  EXPECT_NE(wide.warnings[0].find("about 3 seeds would halve"), std::string::npos);
}

TEST_F(SweepAnswers, CompareWithTheBaseline) {
  // interleaved: cell 1, cell 2, cell 1, cell 2
  const SweepFolder sweep = finish_all(make(two_depths), {{16}, {4}, {16}, {1}});
  const Answers a = answer(sweep);
  ASSERT_EQ(a.pictures.size(), 1u);  // one named reference: depth is a setting like any other
  EXPECT_EQ(a.axes.metric, ErrorMetric::relmse);
  const CellAnswer& cell = a.cells[1];
  EXPECT_EQ(cell.done.size(), 2u);
  EXPECT_NEAR(cell.at[0].error->value, 0.5, 1e-9);
  EXPECT_NEAR(cell.at[0].gain->ratio.value, 8, 1e-9);
  EXPECT_FALSE(a.cells[0].at[0].gain);  // is the baseline itself
  EXPECT_NEAR(cell.to[0].time->value, 4, 1e-9);
  EXPECT_TRUE(cell.to[0].speed_up->at_least);  // 16 / t ends at 2: it never got there
  EXPECT_FALSE(cell.to[1].time);
  EXPECT_EQ(cell.to[1].at_least, 8.1);  // the 81st iteration would have ended then
  EXPECT_NEAR(cell.efficiency->value, 1 / (0.25 * 8), 1e-9);
  EXPECT_NEAR(cell.efficiency_gain->ratio.value, 8, 1e-9);
  ASSERT_EQ(a.pictures[0].render.size(), 1u);
  EXPECT_EQ(a.pictures[0].render[0].best, 1u);
}

TEST_F(SweepAnswers, RunsOfOtherInputsThanTheLatestAreLeftOut) {
  const SweepFolder sweep = finish_all(make(two_depths), {{16}, {4}, {16}, {1}});
  const auto record = [&](std::size_t run, const char* finished, const char* hash) {
    const JobFolder folder = sweep.folder(sweep.plan().runs[run]);
    write_inputs(folder, {{InputRole::scene, "a.glb", 5, hash}});
    JobState state = folder.read_state();
    state.finished = finished;
    folder.write_state(state);
  };
  record(0, "2026-01-01T00:00:03.000Z", "1");
  record(1, "2026-01-01T00:00:02.000Z", "0");
  record(2, "2026-01-01T00:00:01.000Z", "1");  // the file was there again
  Answers a = answer(sweep);
  EXPECT_EQ(a.cells[0].done, (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(a.cells[1].done, (std::vector<std::size_t>{3})) << "of run 3 nothing is known";
  EXPECT_EQ(a.states[State::done], 4U);
  EXPECT_TRUE(a.warnings[0].starts_with("1 of 4 runs have other input files")) << a.warnings[0];
  EXPECT_NE(a.warnings[0].find("scene \"a.glb\" has changed contents"), std::string::npos);
  record(1, "2026-01-01T00:00:02.000Z", "1");
  a = answer(sweep);
  EXPECT_EQ(a.cells[1].done.size(), 2U);
}

TEST_F(SweepAnswers, ADamagedRunIsNamedAndHidesNoOther) {
  const SweepFolder sweep = finish_all(make(two_depths), {{16}, {4}, {16}, {1}});
  const SweepRun& run = sweep.plan().runs[1];
  write_file_atomically(sweep.folder(run).file("outcome.json"), "{\"state\":", false);
  const Answers a = answer(sweep);
  EXPECT_EQ(a.cells[0].done.size(), 2U);
  EXPECT_EQ(a.cells[1].done, (std::vector<std::size_t>{3}));
  EXPECT_TRUE(a.warnings[0].starts_with("run " + run.name + " is excluded")) << a.warnings[0];
  EXPECT_NE(sweep_table(sweep).find(run.name + ",2,1,1,1,damaged,"), std::string::npos);
}

TEST_F(SweepAnswers, NaturalPointsArePlainNumbers) {
  const SweepFolder sweep = finish_all(
      make(R"({"job": {"scene": "a.glb", "reference": "r.exr", "budget": {"iterations": 80}},
    "axes": {"/integrator/max_depth": [2, 4]}})"),
      {{7.52}, {3.1}});
  const Answers a = answer(sweep);
  // All reach 8 s (and their next iteration 0.1 s later); the worst ends at 7.52 / 8 = 0.94.
  EXPECT_EQ(a.pictures[0].seconds, (std::vector<double>{2.02, 4.05, 8.1}));
  EXPECT_EQ(a.pictures[0].errors, (std::vector<double>{1.88, 0.94}));
}

TEST_F(SweepAnswers, BiasIsWhatVarianceAndReferenceLeave) {
  const SweepFolder sweep = finish_all(make(two_depths), {{16}, {4}, {16}, {4}});
  const CellAnswer cell = answer(sweep).cells[1];
  EXPECT_NEAR(cell.variance->value, 0.25, 1e-9);                   // half of the mse, 4 / 8
  EXPECT_NEAR(cell.bias_squared->value, 0.5 - 0.25 - 0.01, 1e-9);  // less the reference's 0.1^2
}

TEST_F(SweepAnswers, TheFloorIsNotSupported) {
  const SweepFolder sweep =
      finish_all(make(two_depths), {{16}, {4, FakeRun{}.report, true}, {16}, {4}});
  const auto json = parse_own_sorted(answers_text(sweep, answer(sweep)));
  EXPECT_EQ(json["cells"][1]["at"][0]["supported"], true);
  EXPECT_EQ(json["cells"][1]["curve"].back()[4], 1);
  EXPECT_EQ(json["pictures"][0]["front"]["render"][0]["supported"], false);
}

TEST_F(SweepAnswers, OnlyCellsOfOnePictureAreCompared) {
  const SweepFolder sweep = finish_all(make(R"({"job": {"scene": "a.glb", "reference": "auto"},
    "axes": {"/resolution": [[8, 8], [16, 16]], "/integrator/next_event_estimation": [true, false]},
    "baseline": {"/resolution": [8, 8]}})"),
                                       {{1}, {2}, {3}, {4}});
  const Answers a = answer(sweep);
  ASSERT_EQ(a.pictures.size(), 2u);
  EXPECT_EQ(a.pictures[0].text, "resolution [8,8]");
  EXPECT_EQ(a.pictures[0].cells, (std::vector<std::size_t>{0, 2}));
  for (const CellAnswer& c : a.cells) {
    for (const ErrorAtTime& at : c.at) EXPECT_FALSE(at.gain);
  }
  ASSERT_EQ(a.warnings.size(), 1u);
  EXPECT_NE(a.warnings[0].find("one seed"), std::string::npos);
}

// A job without a camera renders its scene's first one, whose name only a report tells.
TEST_F(SweepAnswers, TheFirstCameraIsOnePictureWithOrWithoutItsName) {
  const SweepFolder sweep = make(R"({"job": {"scene": "a.glb", "reference": "r.exr"},
    "axes": {"/camera": ["", "room", "hall"]}, "baseline": {"/camera": "room"}})");
  FakeRun unnamed{1}, room{2}, hall{4};
  unnamed.report = room.report = R"({"scene": {"camera": "room"}})";
  hall.report = R"({"scene": {"camera": "hall"}})";
  EXPECT_EQ(answer(sweep).pictures.size(), 3u);  // as long as no report tells it
  const Answers a = answer(finish_all(sweep, {unnamed, room, hall}));
  ASSERT_EQ(a.pictures.size(), 2u);
  EXPECT_EQ(a.pictures[0].cells, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(a.pictures[1].cells, (std::vector<std::size_t>{2}));
  ASSERT_FALSE(a.cells[0].at.empty());
  ASSERT_TRUE(a.cells[0].at[0].gain);
  EXPECT_NEAR(a.cells[0].at[0].gain->ratio.value, 2, 1e-9);
}

TEST_F(SweepAnswers, WhatIsNotDoneTakesNoPart) {
  const SweepFolder sweep = make(two_depths);
  finish(sweep, 0, {16});
  const Answers a = answer(sweep);
  EXPECT_EQ(a.cells[0].done.size(), 1u);
  EXPECT_TRUE(a.cells[1].done.empty());
  EXPECT_TRUE(a.cells[1].at.empty());
  ASSERT_FALSE(a.warnings.empty());
  EXPECT_EQ(a.warnings[0], "3 of 4 runs are not done: results are provisional");
}

std::string prepared(double analysis, const char* built, const char* loaded) {
  return fmt::format(R"({{"seconds": {{"load": 1, "analysis": {}}}, "artefacts": {{"built": [{}],
    "loaded": [{}]}}}})",
                     analysis, built, loaded);
}

TEST_F(SweepAnswers, PreparationColdAndWarm) {
  constexpr const char* skeleton = R"({"name": "voxels"}, {"name": "skeleton"})";
  constexpr const char* from_cache = R"({"name": "skeleton"})";
  // The first run of the sweep builds; every other one loads, also in the second cell.
  const SweepFolder sweep = finish_all(make(two_depths), {{16, prepared(9, skeleton, "")},
                                                          {4, prepared(0.25, "", from_cache)},
                                                          {16, prepared(0.5, "", from_cache)},
                                                          {4, prepared(0.5, "", from_cache)}});
  const Answers a = answer(sweep);
  EXPECT_EQ(a.cells[0].preparation.cold, 10);
  EXPECT_EQ(a.cells[0].preparation.warm, 1.5);
  EXPECT_EQ(a.cells[1].preparation.cold, 10);
  EXPECT_EQ(a.cells[1].preparation.warm, 1.25);
  EXPECT_TRUE(a.cells[1].pays.cold->from_the_start);
}

TEST_F(SweepAnswers, ColdIsNotKnownIfNoRunBuilt) {
  const std::string loads = prepared(0.25, "", R"({"name": "skeleton"})");
  const SweepFolder sweep =
      finish_all(make(two_depths), {{16, loads}, {4, loads}, {16, loads}, {4, loads}});
  const Answers a = answer(sweep);
  EXPECT_FALSE(a.cells[0].preparation.cold);
  EXPECT_EQ(a.cells[0].preparation.warm, 1.25);
  EXPECT_TRUE(a.pictures[0].cold.empty());
  EXPECT_EQ(a.pictures[0].warm.size(), 1u);
}

TEST_F(SweepAnswers, ColdIsNotThatOfAnotherPreparation) {
  constexpr const char* skeleton = R"({"name": "skeleton"})";
  const auto cold = [&](const char* name, const std::string& axis) {
    const SweepFolder sweep = finish_all(
        SweepFolder::create(
            temp.path() / name,
            parse_sweep(
                R"({"job": {"scene": "a.glb", "reference": "r.exr", "budget": {"iterations": 80}},
                                            "axes": {)" +
                axis + "}}")),
        {{16, prepared(9, skeleton, "")}, {16, prepared(0.5, "", skeleton)}});
    return answer(sweep).cells[1].preparation.cold;
  };
  EXPECT_EQ(cold("seed", R"("/seed": [1, 2])"), 10);
  EXPECT_FALSE(cold("environment", R"("/environment": [null, {"file": "sky.exr"}])"));
  EXPECT_FALSE(cold("particles", R"("/particles": [null, {"count": 9, "power": 1}])"));
  EXPECT_FALSE(cold("material", R"("/material": [null, {"name": "floor", "roughness": 0.1}])"));
  EXPECT_FALSE(cold("threads", R"("/threads": [1, 2])"));
}

TEST_F(SweepAnswers, BusyMachinesTaint) {
  const std::string busy = R"({"machine": {"others_share": 0.3, "stolen_share": 0, "mhz": 3000}})";
  const std::string stolen =
      R"({"machine": {"others_share": 0, "stolen_share": 0.2, "mhz": 3000}})";
  const std::string slow = R"({"machine": {"others_share": 0, "stolen_share": 0, "mhz": 2000}})";
  const std::string quiet =
      R"({"machine": {"others_share": 0.04, "stolen_share": 0.04, "mhz": 2900}})";
  const SweepFolder sweep =
      finish_all(make(two_depths), {{16, busy}, {4, stolen}, {16, slow}, {4, quiet}});
  const Answers a = answer(sweep);
  ASSERT_EQ(a.tainted.size(), 3u);
  EXPECT_EQ(a.tainted[0].why, "other processes took 30 %");
  EXPECT_EQ(a.tainted[1].why, "the host took 20 %");
  EXPECT_EQ(a.tainted[2].why, "2000 MHz instead of 3000");
  ASSERT_EQ(a.warnings.size(), 1u);
}

TEST_F(SweepAnswers, ADamagedFileIsNamed) {
  const SweepFolder sweep = finish_all(make(two_depths), {{16}, {4}, {16}, {4}});
  const auto file = sweep.folder(sweep.plan().runs[1]).file("curve.csv");
  std::ofstream(file, std::ios::app) << "9,9\n";
  const std::string warning = answer(sweep).warnings[0];
  EXPECT_NE(warning.find("0002-1/curve.csv, line 6"), std::string::npos) << warning;
}

}  // namespace
}  // namespace lacuna
