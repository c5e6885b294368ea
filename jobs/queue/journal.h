#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

struct JobEntry;

/// Something that happened to a job.
struct JobEvent {
  enum class Kind { changed, progress, removed };
  std::int64_t number = 0;
  Kind kind = Kind::changed;
  std::string id;                         ///< the job's
  std::shared_ptr<const JobEntry> entry;  ///< after the event; none if the job was removed
};

/// The latest events of all jobs, numbered in their order; not every number is used. Safe from any
/// thread.
class Journal {
 public:
  /// `name`: of the database that issued the numbers. Events up to `begin` are unknown.
  void start(std::string name, std::int64_t begin);
  /// Adds an event, which must be later than all others.
  void add(JobEvent event);

  /// The number of the latest event.
  std::int64_t last() const;
  /// The public name of an event's number: "NAME-N". The same after a restart.
  std::string name(std::int64_t number) const;
  /// The number in such a name; none if it belongs to another database, is in the future, or is not
  /// a name.
  std::optional<std::int64_t> number(std::string_view name) const;

  /// The events after `after`, waiting up to `time` for the first; none if some of them were
  /// discarded.
  std::optional<std::vector<JobEvent>> since(std::int64_t after, std::chrono::milliseconds time);

  /// Number of events kept: some minutes of a busy service. A client that was away longer lists the
  /// jobs again.
  static constexpr std::size_t remembered = 8192;

 private:
  std::string name_;
  mutable std::mutex mutex_;
  std::condition_variable grown_;
  std::deque<JobEvent> events_;
  std::int64_t forgotten_ = 0;  // the last discarded number
  std::int64_t last_ = 0;
};

}  // namespace lacuna
