#pragma once

#include "jobs/store/job_folder.h"
#include "server/catalogue.h"
#include "server/events.h"
#include "server/queue.h"
#include "server/router.h"
#include "server/static_files.h"

namespace lacuna {

/// The service's addresses and what each does. All references outlive it.
class Routes {
 public:
  Routes(DataRoot data, ScenesRoots scenes, Queue& queue, StaticFiles page);

  /// For HttpServer.
  Response handle(const Request& request) const;

 private:
  Response post_job(const Request& request) const;
  Response cancel_job(const std::string& id) const;
  Response job_file(const Request& request, const std::string& id, const std::string& name) const;
  void check_files(const JobSpec& spec) const;

  const DataRoot data_;
  const ScenesRoots scenes_;
  Queue& queue_;
  const StaticFiles page_;
  const Catalogue catalogue_;
  mutable Events events_;
  Router router_;
};

}  // namespace lacuna
