#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace lacuna {

/// How many processes the kernel has killed so far because memory ran out: in this process's own
/// control group if it counts them, else on the whole machine; 0 if nobody says.
std::uint64_t oom_kills();

/// The number after the word "oom_kill", as memory.events and /proc/vmstat have it; nothing if they
/// have none.
std::optional<std::uint64_t> parse_oom_kills(std::string_view text);

}  // namespace lacuna
