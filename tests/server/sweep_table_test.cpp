#include "server/tables/sweep_table.h"

#include <gtest/gtest.h>

#include "server/routes/named_files.h"
#include "tests/failing_files.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

SweepSpec three_runs() { return parse_sweep(R"({"job": {"scene": "a.glb"}, "seeds": 3})"); }

SweepEntryPtr make(SweepTable& sweeps) {
  return sweeps.create(three_runs(), expand(three_runs()), {});
}

TEST(SweepTable, KnowsASweepsRunsByTheirIds) {
  const TemporaryFolder tmp;
  SweepTable sweeps(DataRoot{tmp.path()});
  sweeps.read();
  const std::string id = make(sweeps)->id;
  EXPECT_EQ(sweeps.sweep_of(id), "");
  EXPECT_EQ(sweeps.sweep_of(run_job_id(id, 0)), id);
  EXPECT_EQ(sweeps.sweep_of(run_job_id(id, 2)), id);
  EXPECT_EQ(sweeps.sweep_of(run_job_id(id, 3)), "");
  EXPECT_EQ(sweeps.sweep_of("20000101-000000-aaaaaa"), "");
  sweeps.remove(id);
  EXPECT_EQ(sweeps.sweep_of(run_job_id(id, 0)), "");
}

TEST(SweepTable, NoTwoSweepsShareAnId) {
  const TemporaryFolder tmp;
  SweepTable sweeps(DataRoot{tmp.path()});
  sweeps.read();
  std::set<std::string> ids;
  for (int i = 0; i < 20; ++i) {
    const SweepEntryPtr sweep = make(sweeps);
    ids.insert(sweep->id);
    for (std::size_t k = 0; k < 3; ++k) ids.insert(run_job_id(sweep->id, k));
  }
  EXPECT_EQ(ids.size(), 80u);
}

TEST(SweepTable, IsTheSameAfterARestart) {
  const TemporaryFolder tmp;
  std::string running, done, damaged;
  {
    SweepTable sweeps(DataRoot{tmp.path()});
    sweeps.read();
    running = make(sweeps)->id;
    done = make(sweeps)->id;
    damaged = make(sweeps)->id;
    sweeps.set_stage(done, SweepStage::done);
    EXPECT_EQ(sweeps.unfinished(), (std::set<std::string>{running, damaged}));
  }
  put_file(tmp / "sweeps" / damaged / "sweep.json", "{");
  put_file(tmp / "sweeps/not-an-id/sweep.json", "{}");
  SweepTable sweeps(DataRoot{tmp.path()});
  sweeps.read();
  EXPECT_EQ(sweeps.all().size(), 3u);
  EXPECT_EQ(sweeps.unfinished(), std::set<std::string>{running});
  EXPECT_FALSE(sweeps.find(done)->state.finished.empty());
  EXPECT_EQ(sweeps.find(damaged)->state.state, SweepStage::failed);
  EXPECT_EQ(sweeps.sweep_of(run_job_id(damaged, 1)), damaged);
  EXPECT_EQ(sweeps.open(running), sweeps.open(running)) << "its plan is made once";
}

TEST(SweepTable, OneThatCannotBeReadNowIsNotOver) {
  const TemporaryFolder tmp;
  const DataRoot data{tmp.path()};
  std::string id;
  {
    SweepTable sweeps(data);
    sweeps.read();
    id = make(sweeps)->id;
    sweeps.set_stage(id, SweepStage::done);
  }
  for (const char* name : {"state.json", "sweep.json"}) {
    SweepTable sweeps(data);
    {
      const FailingFiles failing(FileCall::open, name);
      sweeps.read();
      EXPECT_FALSE(sweeps.reread(id));
    }
    EXPECT_TRUE(sweeps.find(id)->unread);
    EXPECT_FALSE(sweeps.find(id)->error.empty());
    EXPECT_EQ(sweeps.unfinished(), std::set<std::string>{id}) << "its jobs are not to be removed";
    EXPECT_EQ(sweeps.sweep_of(run_job_id(id, 2)), id) << "and all that may be its jobs are";
    EXPECT_TRUE(sweeps.reread(id));
    EXPECT_EQ(sweeps.find(id)->state.state, SweepStage::done);
    EXPECT_EQ(sweeps.sweep_of(run_job_id(id, 3)), "");
  }
}

TEST(NamedFiles, EachNameIsLookedUpOnce) {
  const TemporaryFolder tmp;
  put_file(tmp / "a.glb", "");
  put_file(tmp / "b.glb", "");  // an empty root would be one that is away
  const ScenesRoots scenes({tmp.path()});
  NamedFiles files(scenes);
  JobSpec job;
  job.scene = "a.glb";
  EXPECT_TRUE(files.missing(job).empty());
  std::filesystem::remove(tmp / "a.glb");
  EXPECT_TRUE(files.missing(job).empty());
  EXPECT_EQ(NamedFiles(scenes).missing(job).at(0).pointer, "/scene");
  job.environment = EnvironmentSettings{.file = "a.glb"};
  EXPECT_EQ(files.missing(job).at(0).pointer, "/environment/file") << "a scene is no image";
}

}  // namespace
}  // namespace lacuna
