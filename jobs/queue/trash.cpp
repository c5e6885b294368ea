#include "jobs/queue/trash.h"

#include "base/log/log.h"

namespace lacuna {

Trash::Trash() : thread_([this](const std::stop_token& ends) { run(ends); }) {}

void Trash::take(std::vector<std::filesystem::path> folders) {
  {
    const std::lock_guard lock(mutex_);
    for (auto& folder : folders) folders_.push_back(std::move(folder));
  }
  changed_.notify_all();
}

void Trash::run(const std::stop_token& ends) {
  for (;;) {
    std::filesystem::path folder;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, ends, [&] { return !folders_.empty(); });
      if (ends.stop_requested()) return;
      folder = std::move(folders_.front());
      folders_.pop_front();
    }
    std::error_code error;
    std::filesystem::remove_all(folder, error);
    if (error) log::warn("{} was not removed: {}", folder.string(), error.message());
  }
}

}  // namespace lacuna
