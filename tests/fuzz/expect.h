#pragma once

#include <cstdio>
#include <cstdlib>

namespace lacuna::fuzz {

/// Ends the process, which makes the input a finding, where a promise is broken.
inline void expect(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

}  // namespace lacuna::fuzz
