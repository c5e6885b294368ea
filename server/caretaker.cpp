#include "server/caretaker.h"

#include <spdlog/spdlog.h>
#include <sys/statvfs.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include "server/retention.h"

namespace lacuna {
namespace {

using std::chrono::steady_clock;

// Renderers write their progress a few times a second: looking at two small files as often is
// simpler than a notice from the kernel, and costs next to nothing.
constexpr std::chrono::milliseconds tick{250};
constexpr int ticks_to_folders = 4, ticks_to_disk = 4, ticks_to_retention = 240;

// Once there was too little room, there has to be this much more than the floor before work goes
// on: or a few checkpoints would stop it again.
constexpr double room_to_go_on = 1.1;

}  // namespace

std::uint64_t free_bytes(const std::filesystem::path& folder) {
  struct statvfs status {};
  if (::statvfs(folder.c_str(), &status) != 0) {
    throw std::system_error(errno, std::generic_category(), folder.string());
  }
  return static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize;
}

Caretaker::Caretaker(DataRoot data, JobTable& table, Queue& queue, CareSettings settings)
    : data_(std::move(data)), table_(table), queue_(queue), settings_(settings) {}

void Caretaker::start() {
  look_at_disk();
  thread_ = std::thread([this] { run(); });
}

void Caretaker::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Caretaker::run() {
  for (int i = 1;; ++i) {
    {
      std::unique_lock lock(mutex_);
      if (changed_.wait_for(lock, tick, [&] { return stopping_; })) return;
    }
    try {
      queue_.look_at_running();
      if (i % ticks_to_folders == 0) table_.rescan_if_changed();
      if (i % ticks_to_disk == 0) look_at_disk();
      if (i % ticks_to_retention == 0) remove_old();
    } catch (const std::exception& error) {
      spdlog::error("looking after the jobs: {}", error.what());
    }
  }
}

void Caretaker::look_at_disk() {
  queue_.save_pending();
  const auto room = static_cast<double>(free_bytes(data_.dir));
  const auto floor = static_cast<double>(settings_.disk_floor);
  const bool low = disk_low_ ? room < room_to_go_on * floor : room < floor;
  if (low != disk_low_) {
    spdlog::warn("{}: {:.0f} MB free, the floor is {:.0f} MB: {}", data_.dir.string(), room / 1e6,
                 floor / 1e6, low ? "jobs wait" : "jobs go on");
  }
  disk_low_ = low;
  queue_.set_disk_low(low);
}

void Caretaker::remove_old() {
  for (const std::string& id :
       outdated(table_.all(), settings_, std::chrono::system_clock::now())) {
    try {
      queue_.remove(id);
      spdlog::info("{}: removed, as the settings of what is kept say", id);
    } catch (const std::exception& error) {  // it was asked to go on, or its folder resists
      spdlog::warn("{} is kept: {}", id, error.what());
    }
  }
}

}  // namespace lacuna
