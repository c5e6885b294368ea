#include "jobs/run/machine_watch.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <string>

namespace lacuna {
namespace {

std::optional<ProcessorTicks> processor_ticks() {
  std::ifstream file("/proc/stat");
  std::string line;
  if (!std::getline(file, line)) return {};
  return parse_processor_ticks(line);
}

std::optional<double> mean_mhz() {
  std::ifstream info("/proc/cpuinfo");
  double sum = 0;
  int n = 0;
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(": ");
    if (!line.starts_with("cpu MHz") || colon == std::string::npos) continue;
    sum += std::strtod(line.c_str() + colon + 2, nullptr);
    ++n;
  }
  return n > 0 && sum > 0 ? std::optional(sum / n) : std::nullopt;
}

/// CPU seconds of this process and of its children that have ended.
double own_seconds() {
  double all = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    ::getrusage(who, &used);
    for (const timeval& t : {used.ru_utime, used.ru_stime}) {
      all += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    }
  }
  return all;
}

}  // namespace

std::optional<ProcessorTicks> parse_processor_ticks(std::string_view stat) {
  // cpu user nice system idle iowait irq softirq steal ...; guests are part of user and nice.
  std::istringstream text{std::string(stat)};
  std::string name;
  std::array<double, 8> ticks{};
  if (!(text >> name) || name != "cpu") return {};
  for (double& t : ticks) {
    if (!(text >> t) || t < 0) return {};
  }
  ProcessorTicks sum;
  for (const double t : ticks) sum.all += t;
  sum.idle = ticks[3] + ticks[4];
  sum.stolen = ticks[7];
  return sum;
}

MachineWatch::MachineWatch() : began_(processor_ticks()), own_began_(own_seconds()) {}

std::optional<Disturbance> MachineWatch::disturbance() const {
  const auto now = processor_ticks();
  constexpr double few = 20;  // ticks: resolution of the shares
  if (!began_ || !now || now->all - began_->all < few) return {};
  const double all = now->all - began_->all;
  const double idle = now->idle - began_->idle, stolen = now->stolen - began_->stolen;
  const double own = (own_seconds() - own_began_) * static_cast<double>(::sysconf(_SC_CLK_TCK));
  Disturbance d;
  d.stolen = std::clamp(stolen / all, 0.0, 1.0);
  d.others = std::clamp((all - idle - stolen - own) / all, 0.0, 1.0);
  std::ifstream("/proc/loadavg") >> d.load;
  d.mhz = mean_mhz();
  return d;
}

}  // namespace lacuna
