#include "server/routes.h"

namespace lacuna {

Routes::Routes(const ServiceFacts& facts, JobTable& table, Queue& queue, SweepTable& sweeps,
               SweepKeeper& keeper, const StaticFiles& page)
    : page_(page),
      jobs_(facts.data, facts.scenes, table, queue),
      sweeps_(facts.scenes, sweeps, table, keeper),
      service_(facts) {
  jobs_.add_to(router_);
  sweeps_.add_to(router_);
  service_.add_to(router_);
}

Response Routes::handle(const Request& request) const {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (reads && page_.has(request.path)) return page_.get(request);
  return router_.route(request);
}

}  // namespace lacuna
