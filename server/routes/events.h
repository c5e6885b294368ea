#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "jobs/queue/store.h"

namespace lacuna {

/// Streams of server-sent events, made from the store's journal. Every event has the journal's
/// number as its id; a client that comes back with the last one it saw (Last-Event-ID) misses
/// nothing, or is told so. All throw HttpError 503 if too many streams are open.
class Events {
 public:
  /// For Response::stream.
  using Stream = std::function<std::optional<std::string>()>;

  explicit Events(Store& store) : store_(store) {}

  /// One job: begins with what is now (`progress`, if there is any, and `state`), follows every
  /// change, and ends once it is over. `last`: the client's Last-Event-ID.
  Stream job(const std::string& id, const std::optional<std::string>& last);
  /// All jobs: `job` with an entry of the list, `removed`, and `reset` where some events are
  /// forgotten and the list has to be read again. Begins after `last`, or now.
  Stream all(const std::optional<std::string>& last);

 private:
  Store& store_;
  std::shared_ptr<std::atomic<int>> open_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace lacuna
