#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace lacuna {

/// Number of processes that the kernel has killed for lack of memory, in this process's control
/// group if that counts them, else on the whole machine; 0 if unknown.
std::uint64_t oom_kills();

/// The number after the word "oom_kill" in memory.events or /proc/vmstat; none if it is missing.
std::optional<std::uint64_t> parse_oom_kills(std::string_view text);

}  // namespace lacuna
