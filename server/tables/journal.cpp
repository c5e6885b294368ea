#include "server/tables/journal.h"

#include <fmt/format.h>

#include <charconv>
#include <random>
#include <utility>

namespace lacuna {
namespace {

// Some minutes of a busy service: who was away longer lists the jobs again.
constexpr std::size_t remembered = 8192;

std::string random_word() {
  std::random_device random;
  return fmt::format("{:08x}", random());
}

}  // namespace

Journal::Journal() : run_(random_word()) {}

void Journal::add(JobEvent::Kind kind, const std::string& id,
                  std::shared_ptr<const JobEntry> entry) {
  {
    const std::lock_guard lock(mutex_);
    events_.push_back({++last_, kind, id, std::move(entry)});
    if (events_.size() > remembered) events_.pop_front();
  }
  grown_.notify_all();
}

std::uint64_t Journal::last() const {
  const std::lock_guard lock(mutex_);
  return last_;
}

std::string Journal::name(std::uint64_t number) const { return fmt::format("{}-{}", run_, number); }

std::optional<std::uint64_t> Journal::number(std::string_view name) const {
  if (!name.starts_with(run_ + "-")) return std::nullopt;
  name.remove_prefix(run_.size() + 1);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size() || number > last()) {
    return std::nullopt;
  }
  return number;
}

std::optional<std::vector<JobEvent>> Journal::since(std::uint64_t after,
                                                    std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  grown_.wait_for(lock, time, [&] { return last_ > after; });
  const std::uint64_t oldest = last_ - events_.size() + 1;
  if (after + 1 < oldest) return std::nullopt;
  return std::vector<JobEvent>(events_.begin() + static_cast<std::ptrdiff_t>(after + 1 - oldest),
                               events_.end());
}

}  // namespace lacuna
