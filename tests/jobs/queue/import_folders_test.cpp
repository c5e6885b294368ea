#include "jobs/queue/import_folders.h"

#include <gtest/gtest.h>

#include "jobs/spec/job_json.h"
#include "tests/failing_files.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

std::string state_text(const std::string& state, const std::string& created) {
  return R"({"state": ")" + state + R"(", "attempts": 2, "exit_code": -1, "created": ")" + created +
         R"(", "started": "", "finished": "", "phase": "", "error": "", "warnings": ["w"]})";
}

/// A data folder as version 0.1 left it: without a database.
class OldFolders : public testing::Test {
 protected:
  std::string make(const std::string& letters, const std::string& state, int second,
                   const std::string& control = {}) {
    const std::string id = "20260131-235959-" + letters;
    JobSpec spec;
    spec.scene = "a.glb";
    put_file(data.jobs() / id / "job.json", write_job(spec));
    put_file(data.jobs() / id / "state.json",
             state_text(state, "2026-01-31T00:00:0" + std::to_string(second) + ".000Z"));
    if (!control.empty()) put_file(data.jobs() / id / "queue.json", control);
    return id;
  }
  Store& import() {
    store.reset();
    store = std::make_unique<Store>(temp / "lacuna.db");
    taken = import_folders(*store, data);
    return *store;
  }

  TemporaryFolder temp;
  DataRoot data{temp.path()};
  std::unique_ptr<Store> store;
  Imported taken;
};

TEST_F(OldFolders, JobsInEveryStateAreTakenOver) {
  const std::map<std::string, State> states{
      {"queued", State::queued},        {"running", State::queued},     {"held", State::held},
      {"cancelling", State::cancelled}, {"interrupted", State::queued}, {"done", State::done},
      {"failed", State::failed},        {"cancelled", State::cancelled}};
  int n = 0;
  std::map<std::string, std::string> ids;
  for (const auto& [name, state] : states) {
    const std::string control = name == "held" ? R"({"held": true, "priority": 3})" : "";
    ids[name] = make("00000" + std::to_string(n), name, 9 - n, control);
    ++n;
  }
  const Store& s = import();
  EXPECT_EQ(taken.jobs, states.size());
  for (const auto& [name, state] : states) {
    const auto entry = s.find(ids[name]);
    EXPECT_EQ(entry->state.state, state) << name;
    EXPECT_EQ(entry->state.attempts, 2);
    EXPECT_EQ(entry->state.warnings, std::vector<std::string>{"w"});
    EXPECT_EQ(entry->scene, "a.glb");
    EXPECT_EQ(entry->begun, name == "running" || name == "interrupted") << name;
  }
  EXPECT_EQ(s.find(ids["held"])->priority, 3);
  std::vector<std::string> listed;
  for (const JobEntry& entry : s.list({}).jobs) listed.push_back(entry.state.created);
  EXPECT_TRUE(std::is_sorted(listed.rbegin(), listed.rend())) << "in the order of their creation";
}

TEST_F(OldFolders, KeysSweepsAndShardsAreKept) {
  const std::string key = R"({"idempotency_key": "k", "body_hash": "h"})";
  const std::string keyed = make("00000a", "done", 1, key);
  make("00000b", "queued", 2, key);  // no version has made two of one key, but somebody may have
  const std::string sweep = "20260131-235959-000100";
  put_file(data.sweeps() / sweep / "sweep.json",
           R"({"label": "l", "job": {"scene": "a.glb"}, "seeds": 2})");
  put_file(data.sweeps() / sweep / "state.json",
           R"({"state": "running", "created": "c", "runs": 2, "idempotency_key": "sk"})");
  const std::string run = make("000102", "done", 3);
  const std::string merged = make("00000c", "queued", 4, R"({"shards": ")" + sweep + "\"}");
  import();
  store->change([&](StoreChange& c) {
    EXPECT_EQ(c.job_of_key("k")->id, keyed);
    EXPECT_EQ(c.sweep_of_key("sk")->id, sweep);
  });
  EXPECT_EQ(store->find(run)->sweep, sweep);
  EXPECT_EQ(store->find(merged)->shards, sweep);
  EXPECT_EQ(store->find_sweep(sweep)->label, "l");
  EXPECT_EQ(store->run_counts(sweep)[State::done], 1U);
}

TEST_F(OldFolders, ADamagedOneIsTakenOverAsFailedAndHidesNoOther) {
  const std::string good = make("00000a", "done", 1);
  const std::string bad = make("00000b", "queued", 2, R"({"idempotency_key": "k"})");
  put_file(data.jobs() / bad / "job.json", "{");
  put_file(data.sweeps() / "20260131-235959-000100" / "sweep.json", "{");
  std::filesystem::create_directories(data.jobs() / "no-job");
  import();
  EXPECT_EQ(taken.jobs, 2U);
  EXPECT_EQ(store->find(good)->state.state, State::done);
  EXPECT_EQ(store->find(bad)->state.state, State::failed);
  EXPECT_NE(store->find(bad)->state.error.find("cannot be read"), std::string::npos);
  EXPECT_EQ(store->find(bad)->key, "k") << "its key still counts";
  EXPECT_EQ(store->find_sweep("20260131-235959-000100")->state, SweepStage::failed);
}

TEST_F(OldFolders, WhatCannotBeReadNowIsLeftForAnotherTime) {
  make("00000a", "done", 1);
  const std::string away = make("00000b", "queued", 2);
  {
    const FailingFiles failing(FileCall::open, away + "/state.json");
    EXPECT_THROW(import(), std::system_error);
  }
  import();
  EXPECT_EQ(taken.jobs, 2U);
  import();
  EXPECT_EQ(taken.jobs, 0U) << "once is enough";
}

TEST_F(OldFolders, AfterALostDatabaseTheOrderIsThatOfAcceptance) {
  const std::string first = make("00000b", "queued", 9), second = make("00000a", "queued", 1);
  JobFolder(data.jobs() / first).write_acceptance({.number = 10, .created = "x", .sweep = "s"});
  JobFolder(data.jobs() / second).write_acceptance({.number = 20, .created = "w"});
  import();
  const std::vector<JobEntry> line = store->unfinished(0, 10);
  ASSERT_EQ(line.size(), 2U);
  EXPECT_EQ(line[0].id, first);
  EXPECT_EQ(line[0].sweep, "s");
  EXPECT_EQ(line[0].state.created, "x");
}

}  // namespace
}  // namespace lacuna
