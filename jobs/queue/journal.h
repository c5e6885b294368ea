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
  std::shared_ptr<const JobEntry> entry;  ///< after it; none if the job was removed
};

/// The latest events of all jobs, numbered in their order; not every number is used. Safe from any
/// thread.
class Journal {
 public:
  /// `name`: of the database that the numbers are of. Nothing is known of what happened up to
  /// `begin`.
  void start(std::string name, std::int64_t begin);
  /// A later event than all others.
  void add(JobEvent event);

  /// The number of the latest event.
  std::int64_t last() const;
  /// An event's number as clients see it: "NAME-N". The same after a restart.
  std::string name(std::int64_t number) const;
  /// The number in such a name; nothing if it is of another database, of the future, or no name.
  std::optional<std::int64_t> number(std::string_view name) const;

  /// What happened after event `after`, waiting up to `time` for something; nothing if some of it
  /// is forgotten.
  std::optional<std::vector<JobEvent>> since(std::int64_t after, std::chrono::milliseconds time);

  /// How many events are kept: some minutes of a busy service. Who was away longer lists the jobs
  /// again.
  static constexpr std::size_t remembered = 8192;

 private:
  std::string name_;
  mutable std::mutex mutex_;
  std::condition_variable grown_;
  std::deque<JobEvent> events_;
  std::int64_t forgotten_ = 0;  // the last number of which nothing is known any more
  std::int64_t last_ = 0;
};

}  // namespace lacuna
