#pragma once

#include <functional>

namespace lacuna {

/// Handles SIGINT and SIGTERM: the returned function, callable from any thread, tells whether
/// either was received. A second SIGINT ends the process at once.
const std::function<bool()>& interrupt_requested();

}  // namespace lacuna
