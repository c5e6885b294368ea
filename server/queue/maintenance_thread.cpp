#include "server/queue/maintenance_thread.h"

#include <chrono>

#include "server/queue/retention.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

// Renderers write their progress a few times a second: looking at two small files as often is
// simpler than a notice from the kernel, and costs next to nothing.
constexpr std::chrono::milliseconds tick{250};
constexpr int ticks_to_folders = 4, ticks_to_disk = 4, ticks_to_retention = 240;

}  // namespace

MaintenanceThread::MaintenanceThread(JobTable& table, Queue& queue, CareSettings settings)
    : table_(table), queue_(queue), settings_(settings) {}

void MaintenanceThread::start() {
  thread_ = std::jthread([this](const std::stop_token& ends) { run(ends); });
}

void MaintenanceThread::stop() { thread_ = {}; }

void MaintenanceThread::run(const std::stop_token& ends) {
  for (int i = 1;; ++i) {
    {
      std::unique_lock lock(mutex_);
      ended_.wait_for(lock, ends, tick, [] { return false; });
      if (ends.stop_requested()) return;
    }
    try {
      queue_.look_at_running();
      if (i % ticks_to_folders == 0 && table_.rescan_if_changed()) queue_.adopt();
      if (i % ticks_to_disk == 0) {
        queue_.save_pending();
        queue_.look_at_disk();
      }
      if (i % ticks_to_retention == 0) remove_old();
    } catch (const std::exception& error) {
      log::error("looking after the jobs: {}", error.what());
    }
  }
}

void MaintenanceThread::remove_old() {
  for (const std::string& id : outdated(table_.all(), table_.sweeps().unfinished(), settings_,
                                        std::chrono::system_clock::now())) {
    try {
      queue_.remove_outdated(id);
      log::info("{}: removed, as the settings of what is kept say", id);
    } catch (const std::exception& error) {  // it was asked to go on, or its folder resists
      log::warn("{} is kept: {}", id, error.what());
    }
  }
}

}  // namespace lacuna
