#include "jobs/queue/process_identity.h"

#include <fmt/format.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <string>

namespace lacuna {
namespace {

std::optional<ProcessStat> stat_of(pid_t pid) {
  if (pid <= 0) return std::nullopt;
  std::ostringstream text;
  text << std::ifstream(fmt::format("/proc/{}/stat", pid)).rdbuf();
  return parse_process_stat(std::move(text).str());
}

/// The present state of the process; none if it has ended.
std::optional<ProcessStat> living(const ProcessIdentity& identity) {
  if (identity.boot != boot_id()) return std::nullopt;
  const auto now = stat_of(identity.pid);
  const bool same = now && now->start_ticks == identity.start_ticks;
  return same && now->state != 'Z' && now->state != 'X' ? now : std::nullopt;
}

}  // namespace

const std::string& boot_id() {
  static const std::string id = [] {
    std::string text;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> text;
    return text;
  }();
  return id;
}

std::optional<ProcessStat> parse_process_stat(std::string_view stat) {
  const auto name_end = stat.rfind(')');  // no later field contains one
  if (name_end == std::string_view::npos) return std::nullopt;
  std::istringstream rest{std::string(stat.substr(name_end + 1))};
  ProcessStat found;
  pid_t parent = 0;
  if (!(rest >> found.state >> parent >> found.group)) return std::nullopt;
  constexpr int group_field = 5, start_field = 22;  // numbered as in proc(5)
  std::string skipped;
  for (int field = group_field + 1; field < start_field; ++field) rest >> skipped;
  if (!(rest >> found.start_ticks)) return std::nullopt;
  return found;
}

std::optional<ProcessIdentity> identity_of(pid_t pid) {
  const auto stat = stat_of(pid);
  if (!stat) return std::nullopt;
  return ProcessIdentity{.pid = pid, .start_ticks = stat->start_ticks};
}

bool is_alive(const ProcessIdentity& identity) { return living(identity).has_value(); }

bool kill_group(const ProcessIdentity& identity, int signal) {
  const auto now = living(identity);
  // A number is not reused while a group has it, so this is the same group.
  return now && now->group == identity.pid && ::kill(-identity.pid, signal) == 0;
}

}  // namespace lacuna
