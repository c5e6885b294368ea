// One step of a request fails: the answer, the folders and what a restart finds agree.
#include <gtest/gtest.h>

#include "jobs/store/new_folder.h"
#include "server/routes/job_posting.h"
#include "tests/failing_files.h"
#include "tests/server/no_executor.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

/// A service over `data` without its threads.
struct Tables {
  explicit Tables(const DataRoot& data) : sweeps(data), table(data, sweeps), disk(data.dir, 0) {
    std::filesystem::create_directories(data.jobs());
    sweeps.read();
    table.rescan();
    queue.start();
  }
  State state(const std::string& id) const { return table.find(id)->state.state; }

  SweepTable sweeps;
  JobTable table;
  NoExecutor executor;
  DiskWatch disk;
  Queue queue{executor, table, disk, {.children = 0}};
  SweepKeeper keeper{sweeps, table, queue, disk, 0};
};

class FailedSyncs : public testing::Test {
 protected:
  FailedSyncs() {
    put_file(temp / "scenes/a.glb", "");
    tables.emplace(data);
  }
  void restart() { tables.emplace(data); }

  /// A job in a state, known to the service.
  std::string make(State state, const std::string& reference = {}) {
    const std::string id = new_job_id();
    JobSpec spec;
    spec.scene = "a.glb";
    spec.budget.iterations = 8;
    spec.reference = reference;
    const JobFolder folder = JobFolder::create(data.jobs() / id, spec);
    JobState known = folder.read_state();
    known.state = state;
    folder.write_state(known);
    tables->queue.add(id);
    return id;
  }

  TemporaryFolder temp;
  DataRoot data{temp / "data"};
  std::optional<Tables> tables;
};

TEST_F(FailedSyncs, ACancelThatIsRefusedDoesNotHappenLater) {
  const std::string id = make(State::queued);
  {
    const FailingFiles failing(FileCall::fsync, id);
    EXPECT_THROW(tables->queue.cancel(id), std::system_error);
    EXPECT_THROW(tables->queue.change(id, 5, true), std::system_error);
  }
  EXPECT_EQ(tables->state(id), State::queued);
  restart();
  EXPECT_EQ(tables->state(id), State::queued);
  EXPECT_EQ(tables->table.find(id)->control, JobControl{});
}

TEST_F(FailedSyncs, AnExtendThatIsRefusedLeavesTheOldBudget) {
  const std::string id = make(State::done);
  Budget larger;
  larger.iterations = 64;
  for (const int spared : {0, 1, 2}) {  // queue.json, state.json, job.json
    {
      const FailingFiles failing(FileCall::fsync, id, spared);
      EXPECT_THROW(tables->queue.extend(id, larger), std::system_error) << spared;
    }
    tables->queue.save_pending();
    restart();
    EXPECT_EQ(tables->state(id), State::done) << spared;
    EXPECT_EQ(tables->table.folder(id).read_job().budget.iterations, 8) << spared;
  }
  tables->queue.extend(id, larger);
  EXPECT_EQ(tables->table.folder(id).read_job().budget.iterations, 64);
}

TEST_F(FailedSyncs, AJobThatIsNotRemovedIsThere) {
  const std::string id = make(State::done);
  {
    const FailingFiles failing(FileCall::fsync, "jobs");
    EXPECT_THROW(tables->queue.remove(id), std::system_error);
  }
  EXPECT_NE(tables->table.find(id), nullptr);
  EXPECT_TRUE(std::filesystem::exists(tables->table.folder(id).file("job.json")));
  tables->queue.remove(id);
  EXPECT_EQ(tables->table.find(id), nullptr);
}

TEST_F(FailedSyncs, WhatAnUnfinishedJobNeedsIsNotRemoved) {
  const std::string needed = make(State::done);
  const std::string user = make(State::queued, needed);
  EXPECT_THROW(tables->queue.remove(needed), Conflict);
  {
    const FailingFiles failing(FileCall::open, user + "/job.json");
    restart();
  }
  EXPECT_TRUE(tables->table.find(user)->unread);
  EXPECT_THROW(tables->queue.remove(needed), Unavailable) << "nobody knows what it needs";
  tables->table.reread(user);
  EXPECT_THROW(tables->queue.remove(needed), Conflict);
  tables->queue.cancel(user);
  tables->queue.remove(needed);
}

/// Posts the same job with the same key.
class Posts : public FailedSyncs {
 protected:
  int post(int shards = 1) {
    const ScenesRoots scenes({temp / "scenes"});
    JobPosting posting(data, scenes, tables->table, tables->queue, tables->sweeps, tables->keeper);
    Request request;
    request.method = "POST";
    request.headers = {{"content-type", "application/json"}, {"idempotency-key", "k"}};
    request.read_body = [&](std::size_t) {
      return R"({"scene": "a.glb", "shards": )" + std::to_string(shards) + "}";
    };
    try {
      return posting.post(request).status;
    } catch (const HttpError& error) {
      return error.status();
    }
  }
  std::size_t jobs() const { return list_job_names(data.jobs()).size(); }
};

TEST_F(Posts, AJobThatIsRefusedIsNotMade) {
  for (const int shards : {1, 2}) {
    const std::size_t before = jobs();
    {
      const FailingFiles failing(FileCall::fsync, shards == 1 ? "jobs" : "sweeps");
      EXPECT_EQ(post(shards), 507);
    }
    EXPECT_EQ(jobs(), before);
    EXPECT_TRUE(tables->sweeps.all().empty());
  }
  EXPECT_EQ(post(), 201);
  restart();
  EXPECT_EQ(post(), 200);
  EXPECT_EQ(jobs(), 1u);
}

TEST_F(Posts, AKeyThatCannotBeReadNowMakesNoSecondJob) {
  EXPECT_EQ(post(), 201);
  {
    const FailingFiles failing(FileCall::open, "/queue.json");
    restart();
  }
  EXPECT_EQ(post(), 503);
  tables->table.reread(list_job_names(data.jobs()).front());
  EXPECT_EQ(post(), 200);
  EXPECT_EQ(jobs(), 1u);
}

TEST_F(FailedSyncs, AJobWaitsForShardsWhoseSweepCannotBeReadNow) {
  const SweepSpec spec = parse_sweep(R"({"job": {"scene": "a.glb"}, "seeds": 2})");
  const std::string sweep = tables->sweeps.create(spec, expand(spec), {})->id;
  const std::string id = make(State::queued);
  JobControl control;
  control.shards = sweep;
  tables->table.folder(id).write_control(control);
  {
    const FailingFiles failing(FileCall::open, sweep + "/state.json");
    restart();
  }
  EXPECT_TRUE(tables->table.waits_for_shards(*tables->table.find(id)));
  EXPECT_THROW(tables->keeper.cancel(sweep), Unavailable);
  EXPECT_THROW(tables->keeper.remove(sweep), Unavailable);
  EXPECT_TRUE(std::filesystem::exists(tables->sweeps.dir(sweep) / "sweep.json"));
}

}  // namespace
}  // namespace lacuna
