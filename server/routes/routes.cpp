#include "server/routes/routes.h"

namespace lacuna {

Routes::Routes(const ServiceFacts& facts, JobTable& table, Queue& queue, SweepTable& sweeps,
               SweepKeeper& keeper, const StaticFiles& page)
    : jobs_(facts.data, facts.scenes, table, queue),
      sweeps_(facts.scenes, sweeps, table, keeper),
      service_(facts) {
  jobs_.add_to(router_);
  sweeps_.add_to(router_);
  service_.add_to(router_);
  page.add_to(router_);
}

}  // namespace lacuna
