#include "server/routes/routes.h"

namespace lacuna {

Routes::Routes(const ServiceFacts& facts, const ServiceWork& work, ExecutorSettings tools,
               const StaticFiles& page, Access& access)
    : jobs_(facts.scenes, work.store, work.queue, work.keeper),
      sweeps_(facts.scenes, work.store, work.folders, work.keeper),
      tools_(std::move(tools), work.store),
      service_(facts) {
  jobs_.add_to(router_);
  sweeps_.add_to(router_);
  tools_.add_to(router_);
  service_.add_to(router_);
  page.add_to(router_);
  access.add_to(router_);
}

}  // namespace lacuna
