#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "jobs/spec/problems.h"

namespace lacuna {

/// The problems that `action` throws as BadJob; none if it throws nothing.
template <class Action>
std::vector<Problem> problems_of(const Action& action) {
  try {
    action();
  } catch (const BadJob& e) {
    return e.problems();
  }
  return {};
}

/// Exactly one problem, there, whose message holds every one of `parts`.
inline void expect_one(const std::vector<Problem>& problems, std::string_view pointer,
                       const std::vector<std::string>& parts) {
  ASSERT_EQ(problems.size(), 1u) << (problems.empty() ? "" : BadJob(problems).what());
  EXPECT_EQ(problems[0].pointer, pointer);
  for (const std::string& part : parts) {
    EXPECT_NE(problems[0].message.find(part), std::string::npos)
        << "no '" << part << "' in: " << problems[0].message;
  }
}

}  // namespace lacuna
