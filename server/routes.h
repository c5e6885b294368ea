#pragma once

#include "server/job_routes.h"
#include "server/router.h"
#include "server/service_routes.h"
#include "server/static_files.h"
#include "server/sweep_routes.h"

namespace lacuna {

/// The service's addresses and what each does. All references outlive it.
class Routes {
 public:
  Routes(const ServiceFacts& facts, JobTable& table, Queue& queue, SweepTable& sweeps,
         SweepKeeper& keeper, const StaticFiles& page);

  /// For HttpServer.
  const Router& router() const { return router_; }

 private:
  JobRoutes jobs_;
  SweepRoutes sweeps_;
  ServiceRoutes service_;
  Router router_;
};

}  // namespace lacuna
