#pragma once

#include <cstdint>
#include <string>

namespace lacuna {

/// The model name in /proc/cpuinfo; "unknown" if it does not say.
std::string processor_name();
/// Hardware threads; at least 1.
int processor_threads();
/// Main memory, bytes.
std::uint64_t memory_bytes();

}  // namespace lacuna
