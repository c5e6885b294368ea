#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "jobs/queue/store.h"

namespace lacuna {

/// Streams of server-sent events, made from the store's journal. Every event has the journal's
/// number as its id; a client that reconnects with the last one (Last-Event-ID) misses nothing, or
/// gets `reset`. All throw HttpError 503 if too many streams are open.
class Events {
 public:
  /// For Response::stream.
  using Stream = std::function<std::optional<std::string>()>;

  explicit Events(Store& store) : store_(store) {}

  /// One job: begins with the present `progress`, if any, and `state`, sends every change, and ends
  /// once the job is over. `last`: the client's Last-Event-ID.
  Stream job(const std::string& id, const std::optional<std::string>& last);
  /// All jobs: `job` with an entry of the list, `removed`, and `reset` if events were discarded and
  /// the list must be read again. Begins after `last`, or now.
  Stream all(const std::optional<std::string>& last);

 private:
  Store& store_;
  std::shared_ptr<std::atomic<int>> open_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace lacuna
