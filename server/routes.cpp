#include "server/routes.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "jobs/spec/job_json.h"
#include "server/conditional.h"
#include "server/entry_json.h"

namespace lacuna {
namespace {

/// The state machine, for programs.
Json states() {
  Json states = Json::array(), transitions = Json::array();
  for (const auto& [state, name, doc] : EnumTable<State>::values) {
    states.push_back({{"name", name}, {"doc", doc}, {"terminal", is_terminal(state)}});
  }
  for (const Transition& t : state_transitions()) {
    transitions.push_back({{"from", enum_name(t.from)},
                           {"to", enum_name(t.to)},
                           {"by", t.by},
                           {"when", t.why}});
  }
  return {{"states", std::move(states)}, {"transitions", std::move(transitions)}};
}

}  // namespace

Routes::Routes(DataRoot data, const ScenesRoots& scenes, JobTable& table, Queue& queue,
               const StaticFiles& page)
    : data_(std::move(data)),
      scenes_(scenes),
      page_(page),
      jobs_(data_, scenes_, table, queue) {
  using Parts = Router::Parts;
  router_.add("GET", "/health", [](const Request&, const Parts&) {
    return json_response(200, {{"status", "ok"}});
  });
  router_.add("GET", "/api/schema/job", [](const Request& request, const Parts&) {
    return with_tag(request, json_response(200, job_schema()));
  });
  router_.add("GET", "/api/states", [](const Request& request, const Parts&) {
    return with_tag(request, json_response(200, states()));
  });
  router_.add("GET", "/api/scenes", [this](const Request&, const Parts&) {
    return json_response(200, {{"scenes", scenes_.list()}});
  });
  jobs_.add_to(router_);
}

Response Routes::handle(const Request& request) const {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (reads && page_.has(request.path)) return page_.get(request);
  return router_.route(request);
}

}  // namespace lacuna
