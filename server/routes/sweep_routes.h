#pragma once

#include "server/http/router.h"
#include "server/routes/sweep_posting.h"
#include "server/sweeps/sweep_keeper.h"
#include "server/tables/job_table.h"
#include "server/tables/sweep_table.h"

namespace lacuna {

/// The addresses below /api/sweeps, and /api/schema/sweep. All references outlive it.
class SweepRoutes {
 public:
  SweepRoutes(const ScenesRoots& scenes, SweepTable& sweeps, const JobTable& jobs,
              SweepKeeper& keeper);
  void add_to(Router& router);

 private:
  void add_collection(Router& router);
  void add_one(Router& router);
  void add_results(Router& router);

  Response list(const Request& request) const;
  Response detail(const Request& request, const std::string& id);
  Response cancel(const Request& request, const std::string& id);
  Response remove(const Request& request, const std::string& id);
  Response answers(const Request& request, const std::string& id);
  Response table(const Request& request, const std::string& id);

  std::shared_ptr<const SweepFolder> open(const SweepEntry& sweep);

  SweepTable& sweeps_;
  const JobTable& jobs_;
  SweepKeeper& keeper_;
  SweepPosting posting_;
};

}  // namespace lacuna
