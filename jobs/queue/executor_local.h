#pragma once

#include <string>
#include <vector>

#include "jobs/queue/executor.h"
#include "jobs/queue/queue_settings.h"

namespace lacuna {

/// The folders and the grace of `settings` as environment variables of a renderer:
/// "LACUNA_DATA=...". Throws std::invalid_argument for a folder that these cannot express.
std::vector<std::string> renderer_environment(const ExecutorSettings& settings);
/// This process's environment with that of renderer_environment(). Throws likewise.
std::vector<std::string> child_environment(const ExecutorSettings& settings);
/// Throws std::invalid_argument if there is no such renderer.
void check_renderer(const ExecutorSettings& settings);

/// Runs each renderer as a child process in its own process group, with only the environment of the
/// queue. Sends SIGTERM to stop it and when the queue dies, SIGKILL after the grace period; its
/// output is appended to the job's log.txt. Applies the settings' limits. A renderer that is killed
/// while the kernel counts an out-of-memory kill is assumed to be its victim.
class LocalExecutor : public Executor {
 public:
  /// Throws std::invalid_argument if there is no such renderer.
  explicit LocalExecutor(ExecutorSettings settings);
  Ending run(const Task& task, const StopSignal& stop, const Notices& notices) override;

 private:
  ExecutorSettings settings_;
  std::vector<std::string> environment_;
};

}  // namespace lacuna
