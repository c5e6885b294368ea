#include <gtest/gtest.h>

#include <set>

#include "jobs/spec/problems.h"
#include "jobs/sweep/sweep_folder.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

SweepSpec spec() {
  return parse_sweep(R"({"job": {"scene": "a.glb"}, "seeds": 3,
                         "axes": {"/integrator/max_depth": [4, 8]}})");
}

TEST(SweepFolder, FromTheCommandLineRunsLieInIt) {
  const TemporaryFolder tmp;
  // Even where its name looks like a service's.
  for (const char* name : {"a.sweep", "20260131-235959-k3x9qa"}) {
    const SweepFolder sweep = SweepFolder::create(tmp / name, spec());
    EXPECT_FALSE(sweep.is_served());
    const SweepRun& run = sweep.plan().runs[3];
    EXPECT_EQ(sweep.folder(run).dir(), tmp / name / "runs" / "0002-2");
    EXPECT_EQ(SweepFolder(tmp / name).folder(run).dir(), sweep.folder(run).dir());
    EXPECT_EQ(SweepFolder::preview(tmp / name, spec()).folder(run).dir(), sweep.folder(run).dir());
  }
}

TEST(SweepFolder, OfAServiceRunsAreItsJobs) {
  const TemporaryFolder tmp;
  const DataRoot data{tmp.path()};
  const std::string id = "20260131-235959-zzzzzy";
  const SweepFolder made = SweepFolder::of_service(data, id, spec(), expand(spec()));
  EXPECT_TRUE(made.is_served());
  EXPECT_EQ(names_in(data.sweeps() / id), std::set<std::string>{"sweep.json"});
  const SweepFolder read((data.sweeps() / id / "").string());  // with a '/' at its end
  EXPECT_EQ(read.id(), id);
  EXPECT_EQ(read.spec(), spec());
  std::set<std::string> ids;
  for (const SweepRun& run : read.plan().runs) {
    EXPECT_EQ(read.folder(run).dir(), data.jobs() / read.job_id(run));
    EXPECT_EQ(run_index(id, read.job_id(run)), run.cell * 3 + std::size_t(run.replicate));
    EXPECT_EQ(read.state(run).state, State::queued) << "it is not there yet";
    ids.insert(read.job_id(run));
  }
  EXPECT_EQ(ids.size(), 6u);
  const SweepRun& run = read.plan().runs[1];
  const JobFolder job = JobFolder::create(read.folder(run).dir(), read.plan().job_of(run));
  EXPECT_EQ(job.id(), read.job_id(read.plan().runs[1]));
  EXPECT_TRUE(job.read_job().exclusive) << "a sweep's runs are alone unless it says otherwise";
}

TEST(SweepFolder, WhatIsNoSweepIsRefused) {
  const TemporaryFolder tmp;
  EXPECT_THROW(SweepFolder{tmp.path()}, BadJob);
  EXPECT_TRUE(contains(message_of<std::runtime_error>([&] {
                         put_file(tmp / "x/state.json", R"({"state": "asleep"})");
                         read_sweep_state(tmp / "x");
                       }),
                       "is corrupt"));
}

}  // namespace
}  // namespace lacuna
