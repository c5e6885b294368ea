#pragma once

namespace lacuna {

/// Thrown by loops when ThreadPool's `stop` returned true: what was being built is discarded. No
/// std::exception, so that nobody takes it for a fault.
struct Stopped {};

}  // namespace lacuna
