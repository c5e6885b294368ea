#pragma once

#include <functional>

namespace lacuna {

/// Handles SIGINT and SIGTERM: the returned function, callable from any thread, tells whether
/// either was received. A second SIGINT ends the process at once.
const std::function<bool()>& interrupt_requested();

/// Seconds that a stop may take, LACUNA_GRACE or 2, whichever is longer. Throws BadJob.
double stop_grace();

/// The seconds that are left after the first signal to write what is to be kept. It is given half
/// of `grace`: the rest is for what cannot be stopped. To remove 700 MB that came too late and to
/// return 1.4 GB of memory took 0.8 s on two busy cores.
double seconds_to_write(double grace);

}  // namespace lacuna
