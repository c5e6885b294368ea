#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/spec/problems.h"
#include "jobs/sweep/expand.h"

namespace lacuna {
namespace {

SweepPlan plan_of(std::string_view sweep) { return expand(parse_sweep(sweep)); }

/// Places and messages of all problems, a line each.
std::string problems_of(std::string_view sweep) {
  try {
    plan_of(sweep);
  } catch (const BadJob& bad) {
    std::string all;
    for (const Problem& p : bad.problems()) all += p.pointer + ": " + p.message + "\n";
    return all;
  }
  return "none";
}

void expect_problem(std::string_view sweep, const std::string& line) {
  const std::string all = problems_of(sweep);
  EXPECT_NE(("\n" + all).find("\n" + line), std::string::npos) << line << "\nin:\n" << all;
}

TEST(Sweep, EveryCombinationTheLastAxisFastest) {
  const SweepPlan plan = plan_of(R"({"label": "depth", "seeds": 2,
    "job": {"scene": "a.glb", "integrator": "path", "seed": 10},
    "axes": {"/resolution": [[64, 64], [32, 16]], "/integrator/max_depth": [4, 8, 12]}})");
  ASSERT_EQ(plan.cells.size(), 6u);
  std::vector<std::pair<int, int>> found;
  for (const SweepCell& c : plan.cells) {
    found.emplace_back(std::get<PathSettings>(c.job.integrator).max_depth, c.job.resolution[0]);
  }
  EXPECT_EQ(found, (std::vector<std::pair<int, int>>{
                       {4, 64}, {4, 32}, {8, 64}, {8, 32}, {12, 64}, {12, 32}}));
  EXPECT_EQ(plan.cells[1].job.label, "depth: max_depth 4, resolution [32,16]");
  ASSERT_EQ(plan.runs.size(), 12u);
  std::set<std::string> names;
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(plan.runs[i].cell, i % 6);  // interleaved
    EXPECT_EQ(plan.job_of(plan.runs[i]).seed, 10 + i / 6);
    names.insert(plan.runs[i].name);
  }
  EXPECT_EQ(names.size(), 12u);
  EXPECT_EQ(plan.runs[7].name, "0002-2");
}

TEST(Sweep, RunsAreAloneUnlessItSaysOtherwise) {
  const auto exclusive = [](const std::string& sweep, const std::string& job) {
    return plan_of("{" + sweep + R"("job": {"scene": "a.glb")" + job + "}}").cells[0].job.exclusive;
  };
  EXPECT_TRUE(exclusive("", ""));
  EXPECT_FALSE(exclusive(R"("alone": false, )", ""));
  EXPECT_TRUE(exclusive(R"("alone": false, )", R"(, "exclusive": true)"));
}

TEST(Sweep, WhatACheckFindsIsToldWhereItComesFrom) {
  const SweepSpec sweep = parse_sweep(R"({"job": {"label": "x"}, "seeds": 4,
    "zip": [{"/scene": ["a.glb", "b.glb"], "/camera": ["c", "d"]}]})");
  std::size_t checked = 0;
  try {
    expand(sweep, [&](const JobSpec& job) {
      ++checked;
      std::vector<Problem> problems{{"/label", "found nothing"}};
      if (job.scene == "b.glb") problems.push_back({"/scene", "is not there"});
      return problems;
    });
    ADD_FAILURE() << "nothing was thrown";
  } catch (const BadJob& bad) {
    EXPECT_EQ(bad.problems(), (std::vector<Problem>{{"/job/label", "found nothing"},
                                                    {"/zip/0/~1scene/1", "is not there"}}));
  }
  EXPECT_EQ(checked, 2u) << "each cell once";
}

TEST(Sweep, InSequence) {
  const SweepPlan plan = plan_of(R"({"seeds": 3, "order": "sequence",
    "job": {"scene": "a.glb"}, "axes": {"/threads": [1, 2]}})");
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(plan.runs[i].cell, i / 3);
}

TEST(Sweep, WithoutAxesIsOneCell) {
  const SweepPlan plan = plan_of(R"({"job": {"scene": "a.glb"}, "seeds": 4})");
  EXPECT_EQ(plan.cells.size(), 1u);
  EXPECT_EQ(plan.runs.size(), 4u);
}

TEST(Sweep, ZippedSettingsChangeTogether) {
  const SweepPlan plan = plan_of(R"({"job": {},
    "axes": {"/integrator/max_depth": [2, 3]},
    "zip": [{"/scene": ["a.glb", "b.glb"], "/camera": ["eye", ""]}]})");
  ASSERT_EQ(plan.cells.size(), 4u);
  for (const SweepCell& c : plan.cells)
    EXPECT_EQ(c.job.scene == "a.glb", c.job.camera.name == "eye");
}

TEST(Sweep, ASettingWithinOneThatIsSweptToo) {
  const SweepPlan plan = plan_of(R"({"job": {"scene": "a.glb"}, "axes": {
    "/integrator": ["path", {"type": "path", "next_event_estimation": false}],
    "/integrator/max_depth": [5]}})");
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& path = std::get<PathSettings>(plan.cells[i].job.integrator);
    EXPECT_EQ(path.max_depth, 5);
    EXPECT_EQ(path.next_event_estimation, i == 0);
  }
}

TEST(Sweep, LeavesOutWhatIsExcluded) {
  const SweepPlan plan = plan_of(R"({"job": {"scene": "a.glb"},
    "axes": {"/threads": [1, 2, 4], "/seed": [1, 2.0, 3]},
    "exclude": [{"/threads": 4, "/seed": 2}, {"/threads": 1}]})");
  EXPECT_EQ(plan.cells.size(), 5u);
  for (const SweepCell& c : plan.cells) {
    EXPECT_FALSE(c.job.threads == 1 || (c.job.threads == 4 && c.job.seed == 2));
  }
}

TEST(Sweep, EveryCellHasItsOwnBaseline) {
  const SweepPlan plan = plan_of(R"({"job": {"scene": "a.glb"},
    "axes": {"/integrator/next_event_estimation": [true, false], "/threads": [1, 2]},
    "exclude": [{"/integrator/next_event_estimation": true, "/threads": 2}],
    "baseline": {"/integrator/next_event_estimation": true}})");
  ASSERT_EQ(plan.cells.size(), 3u);  // true 1, false 1, false 2
  EXPECT_EQ(plan.cells[0].baseline, 0u);
  EXPECT_EQ(plan.cells[1].baseline, 0u);
  EXPECT_FALSE(plan.cells[2].baseline);  // it was left out
}

TEST(Sweep, MistakesAreToldWhereTheyStand) {
  expect_problem(R"({"job": {"scene": "a.glb"}, "axes": {"/threads": [1, -2]}})",
                 "/axes/~1threads/1: found number -2; allowed: an integer from 0 to 1024");
  expect_problem(
      R"({"job": {"scene": "a.glb", "reslution": [1, 1]}, "axes": {"/threads": [1, 2]}})",
      "/job/reslution: unknown key \"reslution\"; did you mean \"resolution\"?");
  expect_problem(R"({"job": {"scene": "a.glb"}, "axes": {"/integrator/max_dept": [1]}})",
                 "/axes/~1integrator~1max_dept/0: unknown key");
  expect_problem(
      R"({"job": {"scene": "a.glb"}, "axes": {"/integrator": [{"type": "path", "max_depth": 0}]}})",
      "/axes/~1integrator/0/max_depth: found number 0");
  expect_problem(R"({"job": {"scene": "a.glb"}, "axes": {"threads": [1]}})",
                 "/axes/threads: is not a JSON pointer");
  expect_problem(R"({"job": {"scene": "a.glb"}, "axes": {"/seed/~2": [1]}})",
                 "/axes/~1seed~1~02: is not a JSON pointer");
  expect_problem(R"({"job": {"scene": "a.glb"}, "axes": {"/resolution/2": [1]}})",
                 "/axes/~1resolution~12: points to no setting");
  expect_problem(R"({"job": {"scene": "a.glb"}, "axes": {"/threads": []}})",
                 "/axes/~1threads: found no values");
  expect_problem(R"({"job": {"scene": "a.glb"}, "axes": {"/threads": [1, 2, 1.0]}})",
                 "/axes/~1threads/2: found 1 again");
  expect_problem(
      R"({"job": {"scene": "a.glb"}, "axes": {"/threads": [1]}, "zip": [{"/threads": [1]}]})",
      "/zip/0/~1threads: is swept twice");
  expect_problem(R"({"job": {}, "zip": [{"/scene": ["a.glb", "b.glb"], "/camera": [""]}]})",
                 "/zip/0/~1scene: found lists of 2 and 1");
  expect_problem(R"({"job": {"scene": "a.glb"}, "seeds": 2, "axes": {"/seed": [1]}})",
                 "/axes/~1seed: is swept by \"seeds\", too");
  expect_problem(
      R"({"job": {"scene": "a.glb"}, "axes": {"/threads": [1]}, "exclude": [{"/threads": 2}]})",
      "/exclude/0/~1threads: found 2; allowed: a value that is swept");
  expect_problem(
      R"({"job": {"scene": "a.glb"}, "axes": {"/threads": [1]}, "exclude": [{"/threads": 1}]})",
      "/exclude: excludes all runs");
  expect_problem(
      R"({"job": {"scene": "a.glb"}, "axes": {"/threads": [1]}, "baseline": {"/seed": 1}})",
      "/baseline/~1seed: is not swept");
  expect_problem(R"({"job": []})", "/job: is not an object");
  expect_problem(R"({"job": {}})", "/job/scene: ");
  expect_problem(R"({"axes": {}})", "/job: ");
}

TEST(Sweep, RefusesMoreRunsThanItWouldEverDo) {
  std::string list;
  for (int i = 0; i < 1000; ++i) list += (i > 0 ? "," : "") + std::to_string(i);
  expect_problem(
      R"({"job": {"scene": "a.glb"}, "seeds": 101, "axes": {"/threads": [)" + list + "]}}",
      ": the sweep has more than 20000 runs");
}

TEST(Sweep, TheExampleIsOne) {
  std::ostringstream text;
  text << std::ifstream(std::string(LACUNA_SOURCE_DIR) + "/jobs/examples/sweep.json").rdbuf();
  const SweepSpec sweep = parse_sweep(text.str());
  EXPECT_EQ(expand(sweep).runs.size(), 12u);
  EXPECT_EQ(parse_sweep(write_document(sweep)), sweep);
}

TEST(Sweep, TextsOfCells) {
  EXPECT_EQ(cell_text({{"/integrator/max_depth", {"4"}}, {"/scene", {"\"a.glb\""}}}),
            "max_depth 4, scene a.glb");
  EXPECT_EQ(cell_text({{"/budget/error/target", {"1"}}, {"/x/target", {"2"}}}),
            "error/target 1, x/target 2");
  EXPECT_EQ(cell_text({{"/integrator", {R"({"type":"path"})"}}}), "integrator path");
  EXPECT_EQ(
      cell_text({{"/integrator", {R"({"reuse":64,"type":"path","guide":{"type":"sd_tree"}})"}},
                 {"/resolution", {"[64,64]"}}}),
      "integrator path (reuse 64, guide sd_tree), resolution [64,64]");
  EXPECT_EQ(cell_text({{"/budget", {R"({"seconds":3,"iterations":5})"}}}),
            "budget seconds 3, iterations 5");
}

TEST(SweepProblems, WhereItIsCompared) {
  expect_problem(R"({"job": {"scene": "a.glb"}, "compare_at": {"seconds": [1, 0]}})",
                 "/compare_at/seconds/1: found 0; allowed: above 0");
  expect_problem(R"({"job": {"scene": "a.glb"}, "compare_at": {"errors": [-1]}})",
                 "/compare_at/errors/0: found -1; allowed: above 0");
  expect_problem(R"({"job": {"scene": "a.glb"}, "compare_at": {"metric": "mse"}})",
                 "/compare_at/metric: found \"mse\" with a job without \"reference\"; allowed: "
                 "\"est_rmse\", or a reference for all");
  EXPECT_EQ(problems_of(R"({"job": {"scene": "a.glb"}, "compare_at": {"metric": "est_rmse"}})"),
            "none");
}

}  // namespace
}  // namespace lacuna
