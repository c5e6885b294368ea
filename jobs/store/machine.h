#pragma once

#include <string>

namespace lacuna {

/// The model name in /proc/cpuinfo; "unknown" if it is missing.
std::string processor_name();
/// Hardware threads; at least 1.
int processor_threads();

}  // namespace lacuna
