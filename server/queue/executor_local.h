#pragma once

#include <string>
#include <vector>

#include "server/queue/executor.h"
#include "server/settings/queue_settings.h"

namespace lacuna {

/// Runs each renderer as a child process in its own process group, with only the environment of the
/// service. Sends SIGTERM to stop it and when the service dies, SIGKILL after the grace period; its
/// output is appended to the job's log.txt. Applies the settings' limits. A renderer that is killed
/// while the kernel counts an out-of-memory kill is assumed to be its victim.
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
