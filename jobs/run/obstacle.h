#pragma once

#include <exception>
#include <string>

namespace lacuna {

/// The type of a transient error that interrupted a job, which can continue from its checkpoint.
enum class Obstacle {
  none,     ///< not transient: the job would fail again
  memory,   ///< memory ran out
  storage,  ///< a file could not be read or written, and may_pass() holds for the error
  input,    ///< InputUnreadable: an input of the job cannot be read now
};

/// From this call on the process records failed allocations. Libraries that catch std::bad_alloc
/// report their own errors, often without a reason; obstacle_of() uses the record for these.
void watch_memory();

Obstacle obstacle_of(const std::exception& e);

/// The reason as text for people. If memory ran out, it is "out of memory" or begins with it,
/// followed by the exception's own text.
std::string reason_of(const std::exception& e);

}  // namespace lacuna
