#include "jobs/queue/journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace lacuna {

void Journal::start(std::string name, std::int64_t begin) {
  name_ = std::move(name);
  forgotten_ = last_ = begin;
}

void Journal::add(JobEvent event) {
  {
    const std::lock_guard lock(mutex_);
    last_ = event.number;
    events_.push_back(std::move(event));
    if (events_.size() > remembered) {
      forgotten_ = events_.front().number;
      events_.pop_front();
    }
  }
  grown_.notify_all();
}

std::int64_t Journal::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

std::string Journal::name(std::int64_t number) const { return fmt::format("{}-{}", name_, number); }

std::optional<std::int64_t> Journal::number(std::string_view name) const {
  if (!name.starts_with(name_ + "-")) return std::nullopt;
  name.remove_prefix(name_.size() + 1);
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const bool whole = error == std::errc() && end == name.data() + name.size();
  if (!whole || number < 0 || number > last()) return std::nullopt;
  return number;
}

std::optional<std::vector<JobEvent>> Journal::since(std::int64_t after,
                                                    std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  grown_.wait_for(lock, time, [&] { return last_ > after; });
  if (after < forgotten_) return std::nullopt;
  const auto first =
      std::upper_bound(events_.begin(), events_.end(), after,
                       [](std::int64_t n, const JobEvent& event) { return n < event.number; });
  return std::vector<JobEvent>(first, events_.end());
}

}  // namespace lacuna
