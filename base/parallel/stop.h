#pragma once

namespace lacuna {

/// Thrown by loops when ThreadPool's `stop` returned true: the unfinished result is discarded. Not
/// a std::exception, so that no handler treats it as an error.
struct Stopped {};

}  // namespace lacuna
