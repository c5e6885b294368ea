#include "jobs/store/machine.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <thread>

namespace lacuna {

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

int processor_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::uint64_t memory_bytes() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t available_memory() {
  std::uint64_t bytes = memory_bytes();
  std::ifstream info("/proc/meminfo");
  std::string name;
  for (std::uint64_t kib = 0; info >> name >> kib; info.ignore(64, '\n')) {
    if (name == "MemAvailable:") bytes = kib * 1024;
  }
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const std::uint64_t used = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    bytes = std::min<std::uint64_t>(bytes, limit.rlim_cur > used ? limit.rlim_cur - used : 0);
  }
  return bytes;
}

std::uint64_t memory_to_take() { return available_memory() / 16 * 15; }

}  // namespace lacuna
