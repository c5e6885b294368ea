#include "jobs/queue/oom_kills.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace lacuna {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();  // files in /proc have no size
  return std::move(text).str();
}

/// The file in which the kernel counts the events of this process's control group (version 2).
std::filesystem::path own_memory_events() {
  std::istringstream groups(text_of("/proc/self/cgroup"));
  for (std::string line; std::getline(groups, line);) {
    if (line.starts_with("0::/")) {
      return std::filesystem::path("/sys/fs/cgroup") / line.substr(4) / "memory.events";
    }
  }
  return {};
}

}  // namespace

std::optional<std::uint64_t> parse_oom_kills(std::string_view text) {
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    std::uint64_t count = 0;
    if (words >> name >> count && name == "oom_kill") return count;
  }
  return std::nullopt;
}

std::uint64_t oom_kills() {
  if (const auto own = parse_oom_kills(text_of(own_memory_events()))) return *own;
  return parse_oom_kills(text_of("/proc/vmstat")).value_or(0);
}

}  // namespace lacuna
