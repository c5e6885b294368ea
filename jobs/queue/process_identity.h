#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace lacuna {

/// The kernel's identifier of this boot of the machine; empty if there is none.
const std::string& boot_id();

/// Identifies a process by its number, its start time in clock ticks since boot, and that boot,
/// which together distinguish it from a later process with the same number.
struct ProcessIdentity {
  pid_t pid = 0;
  std::uint64_t start_ticks = 0;
  std::string boot = boot_id();
  bool operator==(const ProcessIdentity&) const = default;
};

/// Fields of /proc/PID/stat. The second field, the name in parentheses, may contain anything:
/// spaces, parentheses, line breaks.
struct ProcessStat {
  char state = '?';  ///< 'Z', 'X': it has ended
  pid_t group = 0;
  std::uint64_t start_ticks = 0;
};
std::optional<ProcessStat> parse_process_stat(std::string_view stat);

/// The process that has this number now; none if there is none.
std::optional<ProcessIdentity> identity_of(pid_t pid);

/// Whether this process still runs; a zombie has ended.
bool is_alive(const ProcessIdentity& identity);

/// Sends a signal to the group that this process leads. Returns false and sends nothing if it has
/// ended or leads no group.
bool kill_group(const ProcessIdentity& identity, int signal);

}  // namespace lacuna
