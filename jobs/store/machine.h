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
/// How much of it this process may still take: what is available now, or less where a limit on its
/// address space says so, bytes.
std::uint64_t available_memory();
/// What a step may plan to take of it: the rest, a sixteenth, is for what no estimate knows of.
std::uint64_t memory_to_take();

}  // namespace lacuna
