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

bool may_follow(State from, State to) {
  const auto all = state_transitions();
  return std::any_of(all.begin(), all.end(),
                     [&](const Transition& t) { return t.from == from && t.to == to; });
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
  EXPECT_EQ(reached.size(), all_states().size() - 1) << "all but interrupted, of folders alone";
}

TEST(State, EveryUnfinishedJobCanBeCancelled) {
  for (const State from : all_states()) {
    if (is_terminal(from) || from == State::interrupted) continue;
    EXPECT_TRUE(may_follow(from, State::cancelled) || may_follow(from, State::cancelling))
        << enum_name(from);
  }
}

/// What of a person's requests leads from one state to another.
bool some_action_leads(State from, State to) {
  const auto asks = [from](JobAction action) { return allows(from, action); };
  if (to == State::held) return asks(JobAction::hold);
  if (to == State::cancelled || to == State::cancelling) return asks(JobAction::cancel);
  if (from == State::held) return asks(JobAction::release);
  return asks(JobAction::retry) || asks(JobAction::extend);
}

TEST(State, WhatAPersonMayDoIsWhatTheTransitionsSay) {
  for (const Transition& t : state_transitions()) {
    if (t.by != "person") continue;
    EXPECT_TRUE(some_action_leads(t.from, t.to)) << enum_name(t.from) << enum_name(t.to);
  }
  for (const State s : all_states()) {
    EXPECT_EQ(allows(s, JobAction::remove), is_terminal(s)) << enum_name(s);
    EXPECT_FALSE(allows(s, JobAction::cancel) && allows(s, JobAction::retry)) << enum_name(s);
    if (allows(s, JobAction::hold)) {
      EXPECT_TRUE(may_follow(s, State::held)) << enum_name(s);
    }
    if (allows(s, JobAction::cancel)) {
      EXPECT_TRUE(may_follow(s, State::cancelled) || may_follow(s, State::cancelling))
          << enum_name(s);
    }
  }
  EXPECT_EQ(allowed_actions(State::failed),
            (std::vector<std::string>{"retry", "extend", "delete"}));
  EXPECT_TRUE(allowed_actions(State::cancelling).empty());
}

TEST(State, TheDocumentationNamesEveryStateAndChange) {
  const std::string page = state_documentation();
  for (const Transition& t : state_transitions()) {
    const std::string row = "| `" + std::string(enum_name(t.from)) + "` | `" +
                            std::string(enum_name(t.to)) + "` | " + std::string(t.by);
    EXPECT_NE(page.find(row), std::string::npos) << row;
  }
}

TEST(State, NobodyCanAskForAnEndButACancel) {
  for (const Transition& t : state_transitions()) {
    if (t.to != State::done && t.to != State::failed) continue;
    EXPECT_EQ(t.by, "service") << enum_name(t.from);
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
  EXPECT_TRUE(may_follow(State::running, State::queued));
}

}  // namespace
}  // namespace lacuna
