#include "server/tables/entry_json.h"

#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

template <class T>
OrderedJson or_null(const std::optional<T>& value) {
  return value ? OrderedJson(*value) : OrderedJson(nullptr);
}

}  // namespace

OrderedJson to_json(const JobState& s) {
  return {{"state", enum_name(s.state)}, {"phase", s.phase},     {"attempts", s.attempts},
          {"exit_code", s.exit_code},    {"created", s.created}, {"started", s.started},
          {"finished", s.finished},      {"error", s.error},     {"warnings", s.warnings}};
}

OrderedJson state_json(const JobEntry& e) {
  OrderedJson json = to_json(e.state);
  json["obstacle"] = e.obstacle;
  json["place"] = e.place;
  return json;
}

OrderedJson to_json(const Progress& p) {
  return {{"iteration", p.iteration},
          {"seconds", p.seconds},
          {"cpu_seconds", p.cpu_seconds},
          {"share", p.share},
          {"remaining_seconds", or_null(p.remaining_seconds)},
          {"error", or_null(p.error)},
          {"error_metric", p.error_metric}};
}

OrderedJson sweep_json(const JobEntry& e) {
  return e.sweep.empty() ? OrderedJson(nullptr) : OrderedJson(e.sweep);
}

OrderedJson to_json(const JobEntry& e) {
  OrderedJson json = {{"id", e.id},
                      {"label", e.label},
                      {"scene", e.scene},
                      {"integrator", e.integrator},
                      {"sweep", sweep_json(e)},
                      {"picture", e.pictured},
                      {"priority", e.control.priority},
                      {"held", e.control.held}};
  json.update(state_json(e));
  json["progress"] = e.progress ? to_json(*e.progress) : OrderedJson(nullptr);
  return json;
}

}  // namespace lacuna
