#pragma once

#include "jobs/store/job_folder.h"
#include "server/job_routes.h"
#include "server/router.h"
#include "server/static_files.h"

namespace lacuna {

/// The service's addresses and what each does. All references outlive it.
class Routes {
 public:
  Routes(DataRoot data, const ScenesRoots& scenes, JobTable& table, Queue& queue,
         const StaticFiles& page);

  /// For HttpServer.
  Response handle(const Request& request) const;

 private:
  const DataRoot data_;
  const ScenesRoots& scenes_;
  const StaticFiles& page_;
  JobRoutes jobs_;
  Router router_;
};

}  // namespace lacuna
