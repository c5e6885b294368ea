#pragma once

#include <string>
#include <vector>

#include "server/queue/executor.h"
#include "server/settings/queue_settings.h"

namespace lacuna {

/// Each renderer is a child process in a process group of its own, with nothing of the service but
/// its environment. It gets SIGTERM when asked to stop and when the service dies, SIGKILL when the
/// grace has passed; what it prints is added to the job's log.txt. It is held to the settings'
/// limits; a renderer that the kernel kills while it counts a kill for want of memory is taken to
/// be the one.
class LocalExecutor : public Executor {
 public:
  /// Throws std::invalid_argument if there is no such renderer.
  explicit LocalExecutor(ExecutorSettings settings);
  Ending run(const JobFolder& folder, const StopSignal& stop, const Started& started) override;

 private:
  ExecutorSettings settings_;
  std::vector<std::string> environment_;
};

}  // namespace lacuna
