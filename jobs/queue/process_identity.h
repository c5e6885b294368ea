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

/// What /proc/PID/stat says of a process. The second field, its name in parentheses, may hold
/// anything: spaces, parentheses, line breaks.
struct ProcessStat {
  char state = '?';  ///< 'Z', 'X': it has ended
  pid_t group = 0;
  std::uint64_t start_ticks = 0;
};
std::optional<ProcessStat> parse_process_stat(std::string_view stat);

/// The process that has this number now; nothing if none has.
std::optional<ProcessIdentity> identity_of(pid_t pid);

/// This very process is there and has not ended; one that waits for its parent to take its status
/// has ended.
bool is_alive(const ProcessIdentity& identity);

/// Sends a signal to the group that this process leads. False, and nothing is sent, if it has ended
/// or leads no group.
bool kill_group(const ProcessIdentity& identity, int signal);

}  // namespace lacuna
