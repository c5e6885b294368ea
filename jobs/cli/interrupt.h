#pragma once

#include <functional>

namespace lacuna {

/// Turns SIGINT and SIGTERM into a question that can be asked from any thread: was either received?
/// A second SIGINT ends the process at once.
const std::function<bool()>& interrupt_requested();

}  // namespace lacuna
