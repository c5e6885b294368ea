#pragma once

#include <cstdint>
#include <string>

namespace lacuna {

/// The model name in /proc/cpuinfo; "unknown" if it is missing.
std::string processor_name();
/// Hardware threads; at least 1.
int processor_threads();
/// Main memory, bytes.
std::uint64_t memory_bytes();
/// Memory that this process can still allocate, bytes: the available memory, or less by a limit of
/// its address space.
std::uint64_t available_memory();
/// The part of it that a step may plan to use, 15/16; the rest is for allocations outside
/// estimates.
std::uint64_t memory_to_take();

}  // namespace lacuna
