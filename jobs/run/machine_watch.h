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
/// The first line of /proc/stat; nothing if it is none.
std::optional<ProcessorTicks> parse_processor_ticks(std::string_view stat);

/// What else the machine did meanwhile. A time that was taken while `others` + `stolen` is not
/// small is no measurement of the method.
struct Disturbance {
  double others = 0;          ///< share of all processors' time that other processes took, [0, 1]
  double stolen = 0;          ///< share that the host took, [0, 1]
  double load = 0;            ///< processes that wanted to run at the end, mean of a minute
  std::optional<double> mhz;  ///< the processors' mean frequency at the end, if it is told
};

/// Watches the machine from its construction on.
class MachineWatch {
 public:
  MachineWatch();
  /// Since the construction; nothing where /proc does not tell, or after less than a few ticks.
  std::optional<Disturbance> disturbance() const;

 private:
  std::optional<ProcessorTicks> began_;
  double own_began_;
};

}  // namespace lacuna
