#pragma once

#include <semaphore>
#include <string>
#include <vector>

#include "jobs/queue/executor_local.h"
#include "jobs/queue/store.h"
#include "server/http/router.h"

namespace lacuna {

/// /api/figures, /api/schema/figure and /api/jobs/{id}/trace: what `lacuna figure` and `lacuna
/// trace` make of the jobs and sweeps of this service, and of no other files. At most two run at a
/// time, each for two minutes. The store must outlive it.
class ToolRoutes {
 public:
  /// `tools`: the settings of the service's renderers. Throws std::invalid_argument.
  ToolRoutes(ExecutorSettings tools, const Store& store);
  void add_to(Router& router);
  void stop() const { stop_.request(); }  ///< kills what runs, and refuses further requests

 private:
  Response figure(const Request& request);
  Response trace(const Request& request, const std::string& id);
  std::string run(const std::vector<std::string>& arguments,
                  const std::filesystem::path& directory);

  const ExecutorSettings tools_;
  const std::vector<std::string> environment_;
  const Store& store_;
  StopSignal stop_;
  std::counting_semaphore<2> free_{2};
};

}  // namespace lacuna
