#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "jobs/store/state.h"

namespace lacuna {
namespace {

std::vector<State> all_states() {
  std::vector<State> all;
  all.reserve(EnumTable<State>::values.size());
  for (const auto& v : EnumTable<State>::values) all.push_back(v.value);
  return all;
}

TEST(State, ThreeStatesAreFinal) {
  for (const State s : all_states()) {
    const bool is_final = s == State::done || s == State::failed || s == State::cancelled;
    EXPECT_EQ(is_terminal(s), is_final) << enum_name(s);
  }
}

TEST(State, OnlyAPersonWakesAJobThatIsOver) {
  for (const Transition& t : state_transitions()) {
    if (!is_terminal(t.from)) continue;
    EXPECT_EQ(t.to, State::queued) << enum_name(t.from);
    EXPECT_EQ(t.by, "person") << enum_name(t.from);
  }
}

TEST(State, EveryChangeStandsOnceAndEveryStateIsInIt) {
  std::set<std::pair<State, State>> seen;
  std::set<State> reached{State::queued};
  for (const Transition& t : state_transitions()) {
    EXPECT_TRUE(seen.emplace(t.from, t.to).second) << enum_name(t.from) << enum_name(t.to);
    reached.insert(t.to);
  }
  EXPECT_EQ(reached.size(), all_states().size());
}

TEST(State, EveryUnfinishedJobCanBeCancelled) {
  for (const State from : all_states()) {
    if (is_terminal(from)) continue;
    EXPECT_TRUE(may_follow(from, State::cancelled)) << enum_name(from);
  }
}

TEST(State, TheDocumentationNamesEveryStateAndChange) {
  const std::string page = state_documentation();
  for (const Transition& t : state_transitions()) {
    const std::string row = "| `" + std::string(enum_name(t.from)) + "` | `" +
                            std::string(enum_name(t.to)) + "` | " + std::string(t.by);
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

TEST(State, OnlyARendererAtWorkCanFinishAJob) {
  for (const Transition& t : state_transitions()) {
    if (t.to != State::done && t.to != State::interrupted) continue;
    EXPECT_EQ(t.by, "renderer") << enum_name(t.from);
  }
  EXPECT_FALSE(may_follow(State::held, State::done));
}

TEST(State, ARequestToStopIsNotForgotten) {
  EXPECT_TRUE(may_follow(State::running, State::cancelling));
  EXPECT_FALSE(may_follow(State::cancelling, State::running));
  EXPECT_FALSE(may_follow(State::cancelling, State::queued));
}

TEST(State, WorkStartsAgainAfterAKill) {
  EXPECT_TRUE(may_follow(State::queued, State::running));
  EXPECT_TRUE(may_follow(State::interrupted, State::running));
  EXPECT_TRUE(may_follow(State::interrupted, State::queued));
  EXPECT_TRUE(may_follow(State::running, State::running));
  EXPECT_TRUE(may_follow(State::running, State::queued));
}

}  // namespace
}  // namespace lacuna
