#pragma once

#include <functional>

namespace lacuna {

/// Handles SIGINT and SIGTERM: the returned function, callable from any thread, tells whether
/// either was received. A second SIGINT ends the process at once.
const std::function<bool()>& interrupt_requested();

/// Seconds that a stop may take: the larger of LACUNA_GRACE and 2. Throws BadJob.
double stop_grace();

/// Seconds left after the first signal to write a checkpoint: half of `grace`. The other half is
/// for work that cannot be interrupted: removing 700 MB that were written too late and freeing 1.4
/// GB of memory took 0.8 s on two busy cores.
double seconds_to_write(double grace);

}  // namespace lacuna
