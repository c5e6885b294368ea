#pragma once

#include "jobs/queue/queue.h"
#include "jobs/store/job_folder.h"
#include "server/http/router.h"
#include "server/routes/events.h"
#include "server/routes/job_posting.h"

namespace lacuna {

/// The routes below /api/jobs, and /api/events. All references must outlive it.
class JobRoutes {
 public:
  JobRoutes(const ScenesRoots& scenes, Store& store, Queue& queue, SweepKeeper& keeper);
  void add_to(Router& router);

 private:
  void add_collection(Router& router);
  void add_changes(Router& router);
  void add_results(Router& router);

  Response list(const Request& request);
  Response detail(const Request& request, const std::string& id);
  Response change(const Request& request, const std::string& id);
  Response cancel(const Request& request, const std::string& id);
  Response retry(const Request& request, const std::string& id);
  Response extend(const Request& request, const std::string& id);
  Response remove(const Request& request, const std::string& id);
  Response log(const Request& request, const std::string& id);
  Response file(const Request& request, const std::string& id, const std::string& name);
  Response answer(const Request& request, int status, const std::string& id);

  Store& store_;
  Queue& queue_;
  JobPosting posting_;
  Events events_;
};

}  // namespace lacuna
