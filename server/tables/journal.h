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
  enum class Kind { added, state, control, progress, removed };
  std::uint64_t number = 0;
  Kind kind = Kind::state;
  std::string id;                         ///< the job's
  std::shared_ptr<const JobEntry> entry;  ///< after it; none if the job was removed
};

/// The latest events of all jobs, numbered. Safe from any thread.
class Journal {
 public:
  Journal();

  void add(JobEvent::Kind kind, const std::string& id, std::shared_ptr<const JobEntry> entry);

  /// The number of the latest event; 0: none yet.
  std::uint64_t last() const;
  /// An event's number as clients see it: "B-N", where B is of this run of the service.
  std::string name(std::uint64_t number) const;
  /// The number in such a name; nothing if it is of another run, of the future, or no name.
  std::optional<std::uint64_t> number(std::string_view name) const;

  /// What happened after event `after`, waiting up to `time` for something; nothing if some of it
  /// is forgotten.
  std::optional<std::vector<JobEvent>> since(std::uint64_t after, std::chrono::milliseconds time);

 private:
  const std::string run_;
  mutable std::mutex mutex_;
  std::condition_variable grown_;
  std::deque<JobEvent> events_;
  std::uint64_t last_ = 0;
};

}  // namespace lacuna
