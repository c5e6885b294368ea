#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace lacuna {

/// Ticks of all processors since the machine started, from /proc/stat.
struct ProcessorTicks {
  double all = 0;     ///< of all kinds
  double idle = 0;    ///< nothing to do, or waiting for a disk
  double stolen = 0;  ///< the host gave them to another machine
};
/// Parses the first line of /proc/stat; none if it has another form.
std::optional<ProcessorTicks> parse_processor_ticks(std::string_view stat);

/// Other load on the machine during a measurement. Unless `others` + `stolen` is small, the
/// measured time says little about the method.
struct Disturbance {
  double others = 0;          ///< share of all processors' time that other processes took, [0, 1]
  double stolen = 0;          ///< share that the host took, [0, 1]
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
