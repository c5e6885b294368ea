#include "base/storage/available_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace lacuna {
namespace {

/// The part of `bytes` that the limit of `resource` leaves to a process that uses `used` pages.
std::uint64_t within(std::uint64_t bytes, decltype(RLIMIT_AS) resource, std::uint64_t used) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return bytes;
  used *= static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  return std::min<std::uint64_t>(bytes, limit.rlim_cur > used ? limit.rlim_cur - used : 0);
}

}  // namespace

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
  std::uint64_t space = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;  // pages
  std::ifstream("/proc/self/statm") >> space >> resident >> shared >> text >> library >> data;
  return within(within(bytes, RLIMIT_AS, space), RLIMIT_DATA, data);
}

std::uint64_t memory_to_take() { return available_memory() / 16 * 15; }

}  // namespace lacuna
