#include "jobs/queue/store.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <random>
#include <thread>

#include "tests/child_process.h"
#include "tests/failing_files.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using namespace std::chrono_literals;
using Ids = std::vector<std::string>;

JobEntry job(const std::string& id, State state = State::queued) {
  JobEntry entry;
  entry.id = id;
  JobSpec spec;
  spec.scene = "a.glb";
  spec.label = "label of " + id;
  take_spec(entry, spec);
  entry.state.state = state;
  return entry;
}

Ids ids_of(const std::vector<JobEntry>& jobs) {
  Ids ids;
  for (const JobEntry& entry : jobs) ids.push_back(entry.id);
  return ids;
}

class StoreTest : public testing::Test {
 protected:
  void add(JobEntry entry) {
    store->change([&](StoreChange& c) { c.add(entry); });
  }
  void set(const std::string& id, const std::function<void(JobEntry&)>& change) {
    store->change([&](StoreChange& c) {
      auto entry = c.find_job(id);
      change(*entry);
      c.put(*entry);
    });
  }
  void reopen() {
    store.reset();
    store = std::make_unique<Store>(temp / "lacuna.db");
  }

  TemporaryFolder temp;
  std::unique_ptr<Store> store = std::make_unique<Store>(temp / "lacuna.db");
};

TEST_F(StoreTest, KeepsAllThatAnEntrySays) {
  JobEntry entry = job("a", State::held);
  entry.sweep = "s";
  entry.shards = "t";
  entry.reference = "r";
  entry.priority = -7;
  entry.held = entry.exclusive = entry.begun = entry.reopened = entry.pictured = true;
  entry.crashes = 2;
  entry.key = "k";
  entry.body_hash = "h";
  entry.obstacle = "no \"room\"";
  entry.state.warnings = {"one", "t\xc3\xbcw\no"};
  entry.state.error = std::string("\xc3\xa4", 2);
  entry.progress.emplace().iteration = 5;
  entry.progress->seconds = 1.25;
  entry.progress->error = 0.1;
  entry.progress->error_metric = "mse";
  entry.renderer_pid = 12;
  entry.renderer_start = std::int64_t{1} << 40;
  entry.renderer_boot = "boot";
  store->change([&](StoreChange& c) { c.add(entry); });
  EXPECT_GT(entry.number, 0);
  reopen();
  EXPECT_EQ(store->find("a"), entry);
  EXPECT_FALSE(store->find("b"));
}

TEST_F(StoreTest, WhatThrowsChangesNothingAndTheOthersOfACommitHold) {
  constexpr int threads = 8, each = 25;
  std::vector<std::thread> running;
  for (int t = 0; t < threads; ++t) {
    running.emplace_back([&, t] {
      for (int i = 0; i < each; ++i) {
        const auto change = [&](StoreChange& c) {
          JobEntry entry = job(std::to_string(t) + "-" + std::to_string(i));
          c.add(entry);
          if (i % 5 == 4) throw std::runtime_error("no");
        };
        if (i % 5 == 4) {
          EXPECT_THROW(store->change(change), std::runtime_error);
        } else {
          store->change(change);
        }
      }
    });
  }
  for (std::thread& thread : running) thread.join();
  EXPECT_EQ(store->counts()[State::queued], threads * each * 4U / 5);
  EXPECT_FALSE(store->find("3-4"));
  reopen();
  EXPECT_EQ(store->counts()[State::queued], threads * each * 4U / 5);
  EXPECT_TRUE(store->find("3-3"));
}

TEST_F(StoreTest, AKeyIsThatOfOneJob) {
  JobEntry first = job("a"), second = job("b");
  first.key = second.key = "k";
  add(first);
  EXPECT_ANY_THROW(add(second));
  add(job("c"));
  add(job("d"));
  store->change([](StoreChange& c) { EXPECT_EQ(c.job_of_key("k")->id, "a"); });
}

// Against a list in memory, with changes at random, also after a restart.
TEST_F(StoreTest, ListsAndCountsAreThoseOfTheJobs) {
  std::mt19937 random(7);
  std::vector<JobEntry> model;
  const auto pick = [&](std::size_t n) { return random() % n; };
  const auto& states = EnumTable<State>::values;
  for (int step = 0; step < 400; ++step) {
    if (model.size() < 60 || pick(4) == 0) {
      JobEntry entry = job("id" + std::to_string(step), states[pick(states.size())].value);
      entry.sweep = pick(2) == 0 ? "" : "s" + std::to_string(pick(3));
      entry.label = pick(2) == 0 ? "Red" : "blue";
      store->change([&](StoreChange& c) { c.add(entry); });
      model.push_back(entry);
    } else if (pick(3) == 0) {
      const std::size_t i = pick(model.size());
      store->change([&](StoreChange& c) { c.remove_job(model[i].id); });
      model.erase(model.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      JobEntry& entry = model[pick(model.size())];
      entry.state.state = states[pick(states.size())].value;
      store->change([&](StoreChange& c) { c.put(entry); });
    }
    if (step % 100 == 99) reopen();
  }
  for (const std::optional<std::string>& sweep :
       {std::optional<std::string>(), std::optional<std::string>(""),
        std::optional<std::string>("s1")}) {
    for (const std::vector<State>& wanted :
         {std::vector<State>{}, {State::done}, {State::queued, State::held, State::failed}}) {
      for (const std::string words : {"", "rED", "nothing"}) {
        Ids expected;
        for (auto entry = model.rbegin(); entry != model.rend(); ++entry) {
          const bool is_wanted = wanted.empty() || std::find(wanted.begin(), wanted.end(),
                                                             entry->state.state) != wanted.end();
          const bool named = words.empty() || (words == "rED" && entry->label == "Red");
          if (is_wanted && named && (!sweep || *sweep == entry->sweep)) {
            expected.push_back(entry->id);
          }
        }
        Ids listed;
        JobQuery query{.states = wanted, .words = words, .sweep = sweep, .limit = 7};
        do {
          const JobPage page = store->list(query);
          EXPECT_EQ(page.total, expected.size());
          for (const std::string& id : ids_of(page.jobs)) listed.push_back(id);
          query.after = page.next;
        } while (!query.after.empty());
        EXPECT_EQ(listed, expected);
      }
    }
  }
  EXPECT_THROW(store->list({.after = "2026_x"}), std::invalid_argument);
}

TEST_F(StoreTest, TheLineIsThatOfPrioritiesThenOfNumbersWhateverTheClockSays) {
  for (const char* id : {"a", "b", "c", "d", "e"}) {
    JobEntry entry = job(id);
    // The clock is set back, and gives one time twice.
    entry.state.created = id[0] < 'c' ? "2026-01-02T00:00:00.000Z" : "2026-01-01T00:00:00.000Z";
    add(entry);
  }
  add(job("f", State::held));
  add(job("g", State::done));
  EXPECT_EQ(ids_of(store->unfinished(0, 10)), (Ids{"a", "b", "c", "d", "e"}));
  set("d", [](JobEntry& e) { e.priority = 5; });
  set("b", [](JobEntry& e) { e.priority = -1; });
  set("e", [](JobEntry& e) { e.begun = true, e.state.state = State::running; });
  EXPECT_EQ(ids_of(store->unfinished(0, 10)), (Ids{"e", "d", "a", "c", "b"}));
  EXPECT_EQ(ids_of(store->unfinished(1, 2)), (Ids{"d", "a"}));
}

TEST_F(StoreTest, AChangeOfNothingIsNoEventAndNoRevision) {
  add(job("a"));
  const auto last = store->journal().last();
  const auto revision = store->find("a")->revision;
  set("a", [](JobEntry&) {});
  EXPECT_EQ(store->journal().last(), last);
  EXPECT_EQ(store->find("a")->revision, revision);
  set("a", [](JobEntry& e) { e.priority = 1; });
  EXPECT_GT(store->journal().last(), last);
  EXPECT_GT(store->find("a")->revision, revision);
}

TEST_F(StoreTest, EventsGoOnAfterARestart) {
  add(job("a"));
  add(job("b"));
  const std::string seen = store->journal().name(store->journal().last());
  set("a", [](JobEntry& e) { e.begun = true, e.state.state = State::running; });
  store->set_live("a", {.phase = "loading"});
  store->change([](StoreChange& c) { c.remove_job("b"); });
  const std::string last = store->journal().name(store->journal().last());
  reopen();
  Journal& journal = store->journal();
  ASSERT_TRUE(journal.number(seen));
  auto missed = journal.since(*journal.number(seen), 0ms);
  ASSERT_TRUE(missed);
  ASSERT_EQ(missed->size(), 2U);
  EXPECT_EQ((*missed)[0].entry->state.state, State::running);
  EXPECT_EQ((*missed)[0].entry->state.phase, "") << "what a renderer tells is not stored";
  EXPECT_EQ((*missed)[1].kind, JobEvent::Kind::removed);
  EXPECT_EQ((*missed)[1].id, "b");
  ASSERT_TRUE(journal.number(last));
  EXPECT_TRUE(journal.since(*journal.number(last), 0ms)->empty());
  const std::int64_t before = journal.last();
  add(job("c"));
  EXPECT_GT(store->find("c")->revision, before);
  const Store other(temp / "other.db");
  EXPECT_FALSE(other.journal().number(last)) << "of another database";
}

TEST_F(StoreTest, WhatARendererTellsIsForgottenWithItsEnd) {
  add(job("a"));
  store->set_live("a", {.phase = "early"});
  EXPECT_EQ(store->find("a")->state.phase, "") << "it has not begun";
  set("a", [](JobEntry& e) { e.begun = true; });
  const std::int64_t revision = store->find("a")->revision;
  Progress progress;
  progress.iteration = 3;
  store->set_live("a", {.phase = "loading", .place = "here", .progress = progress});
  EXPECT_EQ(store->find("a")->progress->iteration, 3);
  EXPECT_EQ(store->list({}).jobs[0].place, "here");
  EXPECT_EQ(store->find("a")->revision, revision) << "no change that If-Match minds";
  set("a", [](JobEntry& e) { e.begun = false; });
  EXPECT_EQ(store->find("a")->state.phase, "");
  EXPECT_FALSE(store->find("a")->progress);
}

TEST_F(StoreTest, FreeIdsAreNoOtherJobsOrRuns) {
  // A sweep that takes all ids of its second: the next free one is of another.
  SweepEntry all;
  all.id = new_job_id();
  all.runs = 2176782336;  // 36^6
  store->change([&](StoreChange& c) { c.add(all); });
  const std::size_t second = std::string_view("20260131-235959").size();
  EXPECT_NE(store->free_job_id().substr(0, second), all.id.substr(0, second));
  const std::string id = store->free_sweep_id(5);
  EXPECT_TRUE(is_job_id(id));
  EXPECT_NE(id.substr(0, second), all.id.substr(0, second));
  SweepEntry sweep;
  sweep.id = "20260131-235959-000010";
  sweep.runs = 3;
  store->change([&](StoreChange& c) { c.add(sweep); });
  EXPECT_EQ(store->find_sweep(sweep.id)->runs, 3U);
  EXPECT_EQ(store->unfinished_sweeps().size(), 2U);
}

TEST_F(StoreTest, WhatCannotBeStoredHasNotHappened) {
  add(job("a"));
  {
    const FailingFiles failing(FileCall::fsync, "lacuna.db-wal");
    EXPECT_THROW(set("a", [](JobEntry& e) { e.cancel = true; }), std::system_error);
    EXPECT_THROW(add(job("b")), std::system_error);
    EXPECT_FALSE(store->find("a")->cancel);
    EXPECT_EQ(store->counts()[State::queued], 1U);
  }
  add(job("c"));
  reopen();
  EXPECT_FALSE(store->find("a")->cancel);
  EXPECT_FALSE(store->find("b"));
  EXPECT_TRUE(store->find("c"));
}

TEST_F(StoreTest, ASyncThatFailsOnceIsUndoneAtOnce) {
  add(job("a"));
  {
    // The commit's sync; that of the one that overwrites it goes well.
    const FailingFiles failing(FileCall::fsync, "lacuna.db-wal", 0, 1);
    EXPECT_THROW(store->change([&](StoreChange& c) {
      auto entry = *c.find_job("a");
      entry.cancel = true;
      c.put(entry);
    }),
                 std::system_error);
  }
  // After a crash: another process reads the files as they are now.
  std::filesystem::copy(temp / "lacuna.db", temp / "crashed.db");
  std::filesystem::copy(temp / "lacuna.db-wal", temp / "crashed.db-wal");
  const Store crashed(temp / "crashed.db");
  EXPECT_FALSE(crashed.find("a")->cancel);
}

TEST_F(StoreTest, AFullDiskIsAnErrorThatPasses) {
  add(job("a"));
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit all{};
  ::getrlimit(RLIMIT_FSIZE, &all);
  const rlimit little{1, all.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &little);
  EXPECT_THROW(add(job("b")), std::system_error);
  ::setrlimit(RLIMIT_FSIZE, &all);
  EXPECT_FALSE(store->find("b"));
  add(job("b"));
  EXPECT_EQ(store->counts()[State::queued], 2U);
}

TEST_F(StoreTest, TwoProcessesNeverShareIt) {
  const int status = status_in_child([&] {
    try {
      Store second(temp / "lacuna.db");
      return 0;
    } catch (const DatabaseInUse&) {
      return 7;
    }
  });
  EXPECT_EQ(WEXITSTATUS(status), 7);
  add(job("a"));
}

TEST_F(StoreTest, WhatIsNoDatabaseOfOursIsRefused) {
  temp.write("text.db", std::string(5000, 'x'));
  EXPECT_THROW(Store(temp / "text.db"), DatabaseDamaged);
  { Database(temp / "future.db").run("PRAGMA user_version=99"); }
  EXPECT_THROW(Store(temp / "future.db"), DatabaseDamaged);
  EXPECT_THROW(Store(temp / "nowhere/a.db"), std::system_error);
}

}  // namespace
}  // namespace lacuna
