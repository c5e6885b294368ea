#pragma once

#include <gtest/gtest.h>

#include <string>

#include "renderer/core/scene_error.h"

namespace lacuna::test {

/// What `read` says of why it cannot; "accepted" if it can.
template <class Read>
std::string refusal_of(const Read& read) {
  try {
    read();
  } catch (const SceneError& e) {
    return e.what();
  }
  return "accepted";
}

inline void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text << "\nlacks: " << part;
}

}  // namespace lacuna::test
