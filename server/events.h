#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/catalogue.h"

namespace lacuna {

/// Server-sent events of jobs. Each stream begins with what is now (`progress`, if there is any,
/// and `state`), follows every change, and ends after a terminal state.
class Events {
 public:
  explicit Events(const Queue& queue) : queue_(queue) {}

  /// The texts of one stream, for Response::stream. Throws HttpError 503 if too many are open.
  std::function<std::optional<std::string>()> open(const JobFolder& folder);

 private:
  const Queue& queue_;
  std::shared_ptr<std::atomic<int>> open_streams_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace lacuna
