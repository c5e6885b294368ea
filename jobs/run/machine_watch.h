#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace lacuna {

/// Ticks of all processors since the machine started, from /proc/stat.
struct ProcessorTicks {
  double all = 0;     ///< total
  double idle = 0;    ///< idle, or waiting for a disk
  double stolen = 0;  ///< taken by the hypervisor for another machine
};
/// Parses the first line of /proc/stat; none if it has another form.
std::optional<ProcessorTicks> parse_processor_ticks(std::string_view stat);

/// Other load on the machine during a measurement. Measured times are valid only if `others` +
/// `stolen` is small.
struct Disturbance {
  double others = 0;          ///< share of all processors' time that other processes used, [0, 1]
  double stolen = 0;          ///< share taken by the hypervisor, [0, 1]
  double load = 0;            ///< load average over the last minute, at the end
  std::optional<double> mhz;  ///< mean frequency of the processors at the end, if it is known
};

/// Measures the load of the machine since the construction.
class MachineWatch {
 public:
  MachineWatch();
  /// None if /proc/stat is missing or has another form, or if less than a few ticks have passed.
  std::optional<Disturbance> disturbance() const;

 private:
  std::optional<ProcessorTicks> began_;
  double own_began_;
};

}  // namespace lacuna
