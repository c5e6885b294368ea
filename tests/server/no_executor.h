#pragma once

#include "jobs/queue/executor.h"

namespace lacuna {

/// Never asked: the queue of such tests has no runners.
class NoExecutor final : public Executor {
 public:
  Ending run(const Task&, const StopSignal&, const Notices&) override { return {}; }
};

}  // namespace lacuna
