#pragma once

#include <cstdint>

namespace lacuna {

/// Main memory, bytes.
std::uint64_t memory_bytes();
/// Memory that this process can still allocate, bytes: the machine's available memory, or less
/// under a limit of its address space (`ulimit -v`) or of its data (`ulimit -d`).
std::uint64_t available_memory();
/// The share of it that a step may plan to use, 15/16; the rest is for allocations outside
/// estimates.
std::uint64_t memory_to_take();

}  // namespace lacuna
