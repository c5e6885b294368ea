#pragma once

#include <functional>

namespace lacuna {

/// Handles SIGINT and SIGTERM: the returned function, callable from any thread, tells whether
/// either was received. A second SIGINT ends the process at once.
const std::function<bool()>& interrupt_requested();

/// Seconds that a stop may take, LACUNA_GRACE or 2, whichever is longer. Throws BadJob.
double stop_grace();

/// The seconds that are left after the first signal to write what is to be kept. It is given three
/// quarters of `grace`: the rest is for what cannot be stopped, syncing the end of a file and
/// returning memory.
double seconds_to_write(double grace);

}  // namespace lacuna
