#pragma once

#include <exception>
#include <string>

namespace lacuna {

/// What kept a job from being done, though another time it may go on from its checkpoint.
enum class Obstacle {
  none,     ///< it would fail again
  memory,   ///< there was not enough
  storage,  ///< a file could not be read or written for a reason that may pass (may_pass())
};

/// Makes this process remember that memory ran out. Libraries that catch std::bad_alloc report an
/// error of their own in its place, often without a word: obstacle_of() then still knows.
void watch_memory();

Obstacle obstacle_of(const std::exception& e);

/// What went wrong, for a person: "out of memory" in place of, or before, what the exception says.
std::string reason_of(const std::exception& e);

}  // namespace lacuna
