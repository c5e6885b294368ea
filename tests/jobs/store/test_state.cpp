#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "jobs/store/state.h"

namespace lacuna {
namespace {

std::vector<State> all_states() {
  std::vector<State> all;
  all.reserve(EnumTable<State>::values.size());
  for (const auto& v : EnumTable<State>::values) all.push_back(v.value);
  return all;
}

TEST(State, three_states_are_final) {
  for (const State s : all_states()) {
    const bool is_final = s == State::done || s == State::failed || s == State::cancelled;
    EXPECT_EQ(is_terminal(s), is_final) << enum_name(s);
  }
}

TEST(State, nothing_follows_a_final_state) {
  for (const State from : {State::done, State::failed, State::cancelled}) {
    for (const State to : all_states()) EXPECT_FALSE(may_follow(from, to));
  }
}

TEST(State, every_unfinished_job_can_be_cancelled_and_can_fail) {
  for (const State from : all_states()) {
    if (is_terminal(from)) continue;
    EXPECT_TRUE(may_follow(from, State::cancelled)) << enum_name(from);
    EXPECT_TRUE(may_follow(from, State::failed)) << enum_name(from);
  }
}

TEST(State, only_a_renderer_at_work_can_finish_a_job) {
  const std::set<State> at_work{State::running, State::cancelling};
  for (const State from : all_states()) {
    EXPECT_EQ(may_follow(from, State::done), at_work.contains(from)) << enum_name(from);
    EXPECT_EQ(may_follow(from, State::interrupted), at_work.contains(from)) << enum_name(from);
  }
}

TEST(State, a_request_to_stop_is_not_forgotten) {
  EXPECT_TRUE(may_follow(State::running, State::cancelling));
  EXPECT_FALSE(may_follow(State::cancelling, State::running));
  EXPECT_FALSE(may_follow(State::cancelling, State::queued));
}

TEST(State, work_starts_again_after_a_kill) {
  EXPECT_TRUE(may_follow(State::queued, State::running));
  EXPECT_TRUE(may_follow(State::interrupted, State::running));
  EXPECT_TRUE(may_follow(State::interrupted, State::queued));
  EXPECT_TRUE(may_follow(State::running, State::running));
  EXPECT_TRUE(may_follow(State::running, State::queued));
}

}  // namespace
}  // namespace lacuna
