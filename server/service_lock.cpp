#include "server/service_lock.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <tuple>

#include "analysis/storage/atomic_file.h"
#include "server/queue/process_identity.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// A child that a killed service had just forked has the lock, too, until it is a renderer.
constexpr auto patience = 3s;
constexpr auto pause = 10ms;
/// An older service writes its note anew each time it looks, which is about once a second.
constexpr auto note_lasts = 10s;
constexpr std::size_t max_text = 4096;

/// A service: the process, and when it began by the clock, in nanoseconds since 1970.
struct Who {
  ProcessIdentity process;
  std::int64_t began = 0;
  bool operator==(const Who&) const = default;
};

const Who& self() {
  static const Who who{identity_of(::getpid()).value_or(ProcessIdentity{}),
                       std::chrono::system_clock::now().time_since_epoch().count()};
  return who;
}

std::string text_of(const Who& who) {
  return fmt::format("{} {} {} {}\n", who.process.pid, who.process.start_ticks, who.began,
                     who.process.boot);
}

/// Nothing if the file is not there or says nothing.
std::optional<Who> read_who(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return std::nullopt;
  std::istringstream text(read_file(file, max_text));
  Who who;
  if (!(text >> who.process.pid >> who.process.start_ticks >> who.began)) return std::nullopt;
  who.process.boot.clear();
  text >> who.process.boot;
  return who;
}

/// Within one boot by its own clock, which nobody sets.
bool is_older(const Who& a, const Who& b) {
  const bool one_boot = a.process.boot == b.process.boot;
  const auto age = [&](const Who& who) {
    return std::tuple(one_boot ? static_cast<std::int64_t>(who.process.start_ticks) : who.began,
                      who.process.pid, who.process.boot);
  };
  return age(a) < age(b);
}

}  // namespace

ServiceLock::ServiceLock(fs::path data)
    : data_(std::move(data)),
      file_(data_ / ".lacuna-server.lock"),
      note_(data_ / ".lacuna-server.older") {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!lock_) {
    if (auto taken = FileLock::try_take(file_)) {
      lock_.emplace(std::move(*taken));
    } else if (std::chrono::steady_clock::now() >= end) {
      throw std::runtime_error(fmt::format("another lacuna-server works in {}", data_.string()));
    } else {
      std::this_thread::sleep_for(pause);
    }
  }
  if (const std::string why = check_note(); !why.empty()) throw std::runtime_error(why);
  lock_->note(text_of(self()));
}

/// What an older service, whose file was removed, has left for who took the name.
std::string ServiceLock::check_note() const {
  const auto who = read_who(note_);
  if (!who || !is_older(*who, self())) return {};
  std::error_code gone;
  const auto written = fs::last_write_time(note_, gone);
  const bool here = who->process.boot == boot_id();
  const bool lives = !gone && written > fs::file_time_type::clock::now() - note_lasts &&
                     (!here || is_alive(who->process));
  return lives
             ? fmt::format("an older lacuna-server (process {}) works in {}: its lock was removed",
                           who->process.pid, data_.string())
             : "";
}

std::string ServiceLock::look() {
  if (lock_->is_named()) return check_note();
  if (auto taken = FileLock::try_take(file_)) {
    lock_.emplace(std::move(*taken));
    lock_->note(text_of(self()));
    log::warn("{} had been removed; it is there again", file_.string());
    std::error_code ignored;
    fs::remove(note_, ignored);
    return {};
  }
  const auto other = read_who(file_);
  if (other && is_older(*other, self())) {
    return fmt::format("{} was removed, and an older lacuna-server (process {}) has taken it",
                       file_.string(), other->process.pid);
  }
  log::error("{} was removed, and another lacuna-server has taken it: it has to end",
             file_.string());
  write_file_atomically(note_, text_of(self()), false);
  return {};
}

}  // namespace lacuna
