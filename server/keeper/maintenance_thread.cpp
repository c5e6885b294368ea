#include "server/keeper/maintenance_thread.h"

#include <chrono>
#include <utility>

#include "base/log/log.h"
#include "base/storage/file_handle.h"
#include "server/keeper/retention.h"

namespace lacuna {
namespace {

// Renderers write their progress a few times a second: polling two small files as often is simpler
// than inotify, and its cost is negligible.
constexpr std::chrono::milliseconds tick{250};
constexpr int ticks_to_remote = 8;  // two files per job, over the network
constexpr int ticks_to_disk = 4, ticks_to_retention = 240;
// Temporary files are removed at the start, and once more when all of that time are old enough.
constexpr int ticks_to_tidy = 480;

}  // namespace

MaintenanceThread::MaintenanceThread(const Store& store, Queue& queue, DataRoot data,
                                     CareSettings settings)
    : store_(store), queue_(queue), data_(std::move(data)), settings_(settings) {}

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
    do_round(i);
  }
}

void MaintenanceThread::do_round(int number) {
  // A failed step does not prevent the others.
  const auto each = [&](int rounds, const auto& step) {
    if (number % rounds != 0) return;
    try {
      step();
    } catch (const std::exception& error) {
      log::error("maintenance of jobs: {}", error.what());
    }
  };
  each(queue_.is_remote() ? ticks_to_remote : 1, [&] { queue_.look_at_running(); });
  each(ticks_to_disk, [&] { queue_.look_at_disk(); });
  each(ticks_to_retention, [&] { remove_old(); });
  if (number == 1 || number == ticks_to_tidy) list_folders();
  each(1, [&] { tidy_some(); });
}

/// Lists the folders in which a killed process may have left a temporary file.
void MaintenanceThread::list_folders() {
  jobs_to_tidy_ = list_job_names(data_.jobs());
  for (const std::string& id : list_job_names(data_.sweeps())) {
    remove_stale_temporaries(data_.sweeps() / id);
  }
  remove_stale_temporaries(data_.dir);
}

void MaintenanceThread::tidy_some() {
  constexpr int at_once = 200;  // a round stays short
  for (int i = 0; i < at_once && !jobs_to_tidy_.empty(); ++i) {
    const std::filesystem::path folder = data_.jobs() / jobs_to_tidy_.back();
    jobs_to_tidy_.pop_back();
    if (std::filesystem::exists(folder)) remove_stale_temporaries(folder);
  }
  if (jobs_to_tidy_.empty()) jobs_to_tidy_.shrink_to_fit();
}

void MaintenanceThread::remove_old() {
  if (settings_.keep_jobs == 0 && settings_.keep_days == 0) return;
  for (const std::string& id :
       outdated(store_.removable(), settings_, std::chrono::system_clock::now())) {
    try {
      queue_.remove(id);
      log::info("{}: removed by the retention settings", id);
    } catch (const std::exception& error) {  // it was reopened, or its folder cannot be removed
      log::warn("{} is not removed: {}", id, error.what());
    }
  }
}

}  // namespace lacuna
