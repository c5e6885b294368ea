// The database's sync fails in a request: the answer, the folders and what a restart finds agree.
#include <gtest/gtest.h>

#include "jobs/spec/job_json.h"
#include "server/routes/job_posting.h"
#include "tests/failing_files.h"
#include "tests/server/no_executor.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

/// A service over `data` without its threads.
struct Parts {
  explicit Parts(const DataRoot& root) : data(root), store(data.dir / "lacuna.db") {}
  State state(const std::string& id) const { return store.find(id)->state.state; }

  const DataRoot data;
  Store store;
  SweepFolders folders{data};
  NoExecutor executor;
  DiskWatch disk{data.dir, 0};
  Queue queue{executor, store, data.jobs(), disk, {.children = 0}};
  SweepKeeper keeper{store, folders, queue, disk, 0};
};

class FailedSyncs : public testing::Test {
 protected:
  FailedSyncs() {
    put_file(temp / "scenes/a.glb", "");
    std::filesystem::create_directories(data.jobs());
    parts.emplace(data);
  }
  void restart() {
    parts.reset();
    parts.emplace(data);
  }

  std::string make(State state, const std::string& reference = {}) {
    JobEntry job;
    job.id = parts->store.free_job_id();
    JobSpec spec;
    spec.scene = "a.glb";
    spec.budget.iterations = 8;
    spec.reference = reference;
    take_spec(job, spec);
    job.state.state = state;
    parts->store.change([&](StoreChange& c) { c.add(job); });
    parts->queue.take_up({job});
    return job.id;
  }
  std::int64_t iterations(const std::string& id) const {
    return *parse_job(parts->store.find(id)->spec).budget.iterations;
  }

  TemporaryFolder temp;
  DataRoot data{temp / "data"};
  std::optional<Parts> parts;
};

TEST_F(FailedSyncs, ACancelThatIsRefusedDoesNotHappenLater) {
  const std::string id = make(State::queued);
  {
    const FailingFiles failing(FileCall::fsync, "lacuna.db-wal", 0, 1);
    EXPECT_THROW(parts->queue.cancel(id), std::system_error);
  }
  {
    const FailingFiles failing(FileCall::fsync, "lacuna.db-wal", 0, 1);
    EXPECT_THROW(parts->queue.change(id, 5, true), std::system_error);
  }
  EXPECT_EQ(parts->state(id), State::queued);
  restart();
  EXPECT_EQ(parts->state(id), State::queued);
  EXPECT_FALSE(parts->store.find(id)->held);
}

TEST_F(FailedSyncs, AnExtendThatIsRefusedLeavesTheOldBudget) {
  const std::string id = make(State::done);
  Budget larger;
  larger.iterations = 64;
  {
    const FailingFiles failing(FileCall::fsync, "lacuna.db-wal");
    EXPECT_THROW(parts->queue.extend(id, larger), std::system_error);
  }
  restart();
  EXPECT_EQ(parts->state(id), State::done);
  EXPECT_EQ(iterations(id), 8);
  parts->queue.extend(id, larger);
  EXPECT_EQ(iterations(id), 64);
}

TEST_F(FailedSyncs, AJobThatIsNotRemovedIsThere) {
  const std::string id = make(State::done);
  for (const char* file : {"jobs", "lacuna.db-wal"}) {
    {
      const FailingFiles failing(FileCall::fsync, file);
      EXPECT_THROW(parts->queue.remove(id), std::system_error);
    }
    EXPECT_TRUE(parts->store.find(id));
    EXPECT_TRUE(std::filesystem::exists(parts->queue.folder(id).file("job.json")));
  }
  parts->queue.remove(id);
  EXPECT_FALSE(parts->store.find(id));
  EXPECT_FALSE(std::filesystem::exists(parts->queue.folder(id).dir()));
}

TEST_F(FailedSyncs, WhatAnUnfinishedJobNeedsIsNotRemoved) {
  const std::string needed = make(State::done);
  const std::string user = make(State::queued, needed);
  EXPECT_THROW(parts->queue.remove(needed), Conflict);
  parts->queue.cancel(user);
  parts->queue.remove(needed);
}

/// Posts the same job with the same key.
class Posts : public FailedSyncs {
 protected:
  int post(int shards = 1) {
    const ScenesRoots scenes({temp / "scenes"});
    JobPosting posting(scenes, parts->store, parts->queue, parts->keeper);
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
};

TEST_F(Posts, AJobThatIsRefusedIsNotMade) {
  for (const int shards : {1, 2}) {
    {
      const FailingFiles failing(FileCall::fsync, "lacuna.db-wal");
      EXPECT_EQ(post(shards), 507);
    }
    EXPECT_EQ(parts->store.list({}).total, 0U);
    EXPECT_TRUE(parts->store.sweeps().empty());
    EXPECT_TRUE(list_job_names(data.jobs()).empty());
  }
  EXPECT_EQ(post(), 201);
  restart();
  EXPECT_EQ(post(), 200);
  EXPECT_EQ(post(2), 422);
  EXPECT_EQ(list_job_names(data.jobs()).size(), 1U);
}

TEST_F(Posts, AcceptedWithoutAFolderIsAcceptedAllTheSame) {
  {
    const FailingFiles failing(FileCall::open, "/.job.json");
    EXPECT_EQ(post(), 201);
  }
  EXPECT_EQ(post(), 200);
}

}  // namespace
}  // namespace lacuna
