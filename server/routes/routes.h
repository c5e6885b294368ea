#pragma once

#include "server/http/access.h"
#include "server/http/router.h"
#include "server/http/static_files.h"
#include "server/routes/job_routes.h"
#include "server/routes/service_routes.h"
#include "server/routes/sweep_routes.h"
#include "server/routes/tool_routes.h"

namespace lacuna {

/// The jobs and sweeps that requests read and change.
struct ServiceWork {
  Store& store;
  Queue& queue;
  SweepFolders& folders;
  SweepKeeper& keeper;
};

/// All routes of the service. All references must outlive it.
class Routes {
 public:
  Routes(const ServiceFacts& facts, const ServiceWork& work, ExecutorSettings tools,
         const StaticFiles& page, Access& access);

  /// For HttpServer.
  const Router& router() const { return router_; }
  /// Ends the child processes of requests.
  void stop() const { tools_.stop(); }

 private:
  JobRoutes jobs_;
  SweepRoutes sweeps_;
  ToolRoutes tools_;
  ServiceRoutes service_;
  Router router_;
};

}  // namespace lacuna
