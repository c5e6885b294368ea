#include "server/queue/maintenance_thread.h"

#include <chrono>

#include "analysis/storage/file_handle.h"
#include "server/queue/retention.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

// Renderers write their progress a few times a second: looking at two small files as often is
// simpler than a notice from the kernel, and costs next to nothing.
constexpr std::chrono::milliseconds tick{250};
constexpr int ticks_to_remote = 8;  // two files of each job, over the network
constexpr int ticks_to_folders = 4, ticks_to_disk = 4, ticks_to_lock = 4, ticks_to_retention = 240;
// Temporary files are looked for at the start, and once more when all that were left then are old
// enough to be taken away.
constexpr int ticks_to_tidy = 480;
// The index of jobs that are over, for the next start: soon after a start that had to read folders.
constexpr int first_index = 8, ticks_to_index = 1200;

}  // namespace

MaintenanceThread::MaintenanceThread(JobTable& table, Queue& queue, CareSettings settings,
                                     std::function<void()> look)
    : table_(table), queue_(queue), settings_(settings), look_(std::move(look)) {}

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
  // What fails keeps nothing else from being done.
  const auto each = [&](int rounds, const auto& step) {
    if (number % rounds != 0) return;
    try {
      step();
    } catch (const std::exception& error) {
      log::error("looking after the jobs: {}", error.what());
    }
  };
  each(queue_.is_remote() ? ticks_to_remote : 1, [&] { queue_.look_at_running(); });
  each(ticks_to_folders, [&] {
    if (table_.rescan_if_changed()) queue_.adopt();
  });
  each(ticks_to_disk, [&] { queue_.save_pending(); });
  each(ticks_to_disk, [&] { queue_.look_at_disk(); });
  each(ticks_to_lock, [&] { look_(); });
  each(ticks_to_retention, [&] { remove_old(); });
  if (number == 1 || number == ticks_to_tidy) list_folders();
  each(1, [&] { tidy_some(); });
  if (number == first_index) each(1, [&] { table_.save_index(); });
  each(ticks_to_index, [&] { table_.save_index(); });
}

/// Those in which a killed write may have left its temporary file.
void MaintenanceThread::list_folders() {
  jobs_to_tidy_ = table_.all();
  for (const SweepEntryPtr& sweep : table_.sweeps().all()) {
    remove_stale_temporaries(table_.sweeps().dir(sweep->id));
  }
  remove_stale_temporaries(table_.data().dir);
}

void MaintenanceThread::tidy_some() {
  constexpr int at_once = 200;  // a round stays short
  for (int i = 0; i < at_once && !jobs_to_tidy_.empty(); ++i) {
    const std::filesystem::path folder = table_.folder(jobs_to_tidy_.back()->id).dir();
    jobs_to_tidy_.pop_back();
    if (std::filesystem::exists(folder)) remove_stale_temporaries(folder);
  }
  if (jobs_to_tidy_.empty()) jobs_to_tidy_.shrink_to_fit();
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
