#include "analysis/artefacts/store.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <system_error>
#include <thread>

#include "analysis/artefacts/cache_folder.h"
#include "analysis/artefacts/entry_file.h"
#include "base/parallel/stop.h"
#include "base/storage/atomic_file.h"
#include "base/storage/file_lock.h"
#include "base/storage/peak_memory.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Seconds that this thread has spent in completed requests nested in the present one.
thread_local double inner_seconds = 0;

/// The time of one request, without the requests for its inputs.
class OwnTime {
 public:
  OwnTime() { inner_seconds = 0; }
  OwnTime(const OwnTime&) = delete;
  OwnTime& operator=(const OwnTime&) = delete;
  ~OwnTime() { inner_seconds = outer_ + seconds_since(start_); }
  double seconds() const { return seconds_since(start_) - inner_seconds; }

 private:
  const double outer_ = inner_seconds;
  const Clock::time_point start_ = Clock::now();
};

/// Text of a lock file for waiting processes: the owner.
std::string owner_text() {
  char host[256] = "unknown";
  ::gethostname(host, sizeof host - 1);
  return fmt::format("process {} on {}, since {:%Y-%m-%dT%H:%M:%SZ}", ::getpid(), host,
                     fmt::gmtime(std::chrono::system_clock::now()));
}

std::string owner_of(const fs::path& lock) {
  constexpr std::size_t longest = 1000;
  try {
    std::string text = read_file(lock, longest);
    if (!text.empty()) return text;
  } catch (const std::exception&) {
    // The lock was just released, or has no such text.
  }
  return "another process";
}

}  // namespace

/// One request that this process cannot serve from memory.
class ArtefactStore::Attempt {
 public:
  Attempt(const ArtefactStore& store, const ArtefactKey& key, const Request& request)
      : store_(store),
        settings_(store.settings_),
        key_(key),
        request_(request),
        file_(settings_.folder / entry_name(key)) {
    record_.type = key.type();
  }

  std::shared_ptr<const void> run();
  /// Valid after run().
  ArtefactRecord record() const { return record_; }

 private:
  std::shared_ptr<const void> load();
  /// None if there is no lock; the reason was reported.
  std::optional<FileLock> take_lock();
  std::optional<FileLock> wait_for_lock(const fs::path& file);
  void keep(const void* value);
  void report(const std::string& what);
  /// Throws Stopped when interrupted: large artefacts take seconds to pack and to unpack.
  std::function<void()> check_stop() const {
    return [&stop = settings_.interrupted] {
      if (stop && stop()) throw Stopped{};
    };
  }

  const ArtefactStore& store_;
  const StoreSettings& settings_;
  const ArtefactKey& key_;
  const Request& request_;
  const fs::path file_;
  ArtefactRecord record_;
  bool timed_out_ = false;
};

std::shared_ptr<const void> ArtefactStore::Attempt::run() {
  const OwnTime time;
  const auto finish = [&](std::shared_ptr<const void> value, ArtefactRecord::Origin origin) {
    record_.origin = origin;
    record_.seconds = time.seconds() - record_.waited_seconds;
    record_.peak_memory_bytes = peak_memory();
    return value;
  };
  const auto build = [&] {
    if (settings_.building) settings_.building(key_.type());
    return request_.build();
  };
  if (settings_.folder.empty()) {
    return request_.build ? finish(build(), ArtefactRecord::Origin::built) : nullptr;
  }
  if (auto value = load()) return finish(std::move(value), ArtefactRecord::Origin::loaded);
  if (!request_.build) return nullptr;
  auto lock = take_lock();
  // The previous owner of the lock may have built it.
  if (lock) {
    if (auto value = load()) return finish(std::move(value), ArtefactRecord::Origin::loaded);
  }
  auto value = build();
  if (!timed_out_) keep(value.get());
  return finish(std::move(value), ArtefactRecord::Origin::built);
}

std::shared_ptr<const void> ArtefactStore::Attempt::load() {
  std::shared_ptr<const void> value;
  EntryHeader header;
  const auto refusal = read_entry(file_, key_, header, [&](ArtefactReader& in) {
    in.before_block(check_stop());
    value = request_.decode(in);
  });
  if (!refusal) {
    // Records the time of its last use. On a read-only disk the order does not matter.
    ::utimensat(AT_FDCWD, file_.c_str(), nullptr, 0);
    struct stat status {};
    if (::stat(file_.c_str(), &status) == 0) {
      record_.disk_bytes = static_cast<std::uint64_t>(status.st_size);
    }
    record_.content_bytes = header.content_bytes;
    record_.remark.clear();
    return value;
  }
  const std::string found = fmt::format("its cache entry: {}", refusal->text);
  if (refusal->fault != EntryFault::missing && record_.remark != found) report(found);
  return nullptr;
}

std::optional<FileLock> ArtefactStore::Attempt::take_lock() {
  try {
    fs::create_directories(settings_.folder);
    return wait_for_lock(entry_lock_file(file_));
  } catch (const std::system_error&) {
    // An unwritable folder is reported when the artefact is cached; without file locks it may
    // merely be built twice.
    return std::nullopt;
  }
}

std::optional<FileLock> ArtefactStore::Attempt::wait_for_lock(const fs::path& file) {
  constexpr auto shortest = std::chrono::milliseconds(2), longest = std::chrono::milliseconds(100);
  const auto start = Clock::now();
  bool told = false;
  for (auto pause = shortest;; pause = std::min(2 * pause, longest)) {
    auto lock = FileLock::try_take(file);
    if (pause > shortest) record_.waited_seconds = seconds_since(start);
    if (lock) {
      lock->remove_at_end();
      lock->note(owner_text());
      return lock;
    }
    if (settings_.interrupted && settings_.interrupted()) {
      throw WaitInterrupted(
          fmt::format("interrupted while waiting for \"{}\" by {}", key_.type(), owner_of(file)));
    }
    if (record_.waited_seconds >= settings_.wait_seconds) {
      timed_out_ = true;
      report(fmt::format("{} has not finished it in {:.0f} s; it is built without the cache",
                         owner_of(file), settings_.wait_seconds));
      return std::nullopt;
    }
    if (!told && pause == longest && settings_.message) {
      settings_.message(fmt::format("waiting for \"{}\" by {}", key_.type(), owner_of(file)));
      told = true;
    }
    std::this_thread::sleep_for(pause);
  }
}

void ArtefactStore::Attempt::keep(const void* value) {
  try {
    const std::string entry = pack_entry(key_, settings_.label, [&](ArtefactWriter& out) {
      out.before_block(check_stop());
      request_.encode(out, value);
      record_.content_bytes = out.written();
    });
    if (entry.size() > settings_.byte_limit) {
      return report(fmt::format("it is not cached: its {} bytes exceed the cache's limit, {}",
                                entry.size(), settings_.byte_limit));
    }
    fs::create_directories(settings_.folder);
    write_file_atomically(file_, entry);
    record_.disk_bytes = entry.size();
  } catch (const std::system_error& e) {
    return report(fmt::format("it is not cached: {}", e.what()));
  } catch (const std::bad_alloc&) {
    return report("it is not cached: not enough memory to compress it");
  }
  trim_cache(settings_.folder, settings_.byte_limit, file_);
}

void ArtefactStore::Attempt::report(const std::string& what) {
  if (!record_.remark.empty()) record_.remark += "; ";
  record_.remark += what;
  store_.warn(
      fmt::format("artefact \"{}\" ({}): {}", key_.type(), file_.filename().string(), what));
}

std::shared_ptr<const void> ArtefactStore::get_any(const ArtefactKey& key, const Request& request) {
  Slot& slot = slot_of(key, request.type);
  const std::lock_guard busy(slot.busy);
  if (auto held = slot.value.lock()) return held;
  Attempt attempt(*this, key, request);
  auto value = attempt.run();
  if (!value) return nullptr;
  slot.value = value;
  add(attempt.record());
  return value;
}

ArtefactStore::Slot& ArtefactStore::slot_of(const ArtefactKey& key, std::type_index type) {
  const std::lock_guard guard(mutex_);
  Slot& slot = slots_.try_emplace(key.text(), type).first->second;
  if (slot.type != type) {
    throw std::logic_error(fmt::format("two types of artefact have the key {}", key.text()));
  }
  return slot;
}

void ArtefactStore::warn(const std::string& line) const {
  if (settings_.warning) settings_.warning(line);
}

void ArtefactStore::add(ArtefactRecord record) {
  const std::lock_guard guard(mutex_);
  records_.push_back(std::move(record));
}

void ArtefactStore::not_needed(const std::string& type) {
  ArtefactRecord record;
  record.type = type;
  add(std::move(record));
}

std::vector<ArtefactRecord> ArtefactStore::records() const {
  const std::lock_guard guard(mutex_);
  return records_;
}

}  // namespace lacuna
