#include "server/routes/entry_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

template <class T>
OrderedJson or_null(const std::optional<T>& value) {
  return value ? OrderedJson(*value) : OrderedJson(nullptr);
}

std::string place_of(const JobEntry& e) {
  const bool waits = e.state.state == State::queued && e.state.attempts == 0 && !e.shards.empty();
  if (!e.place.empty() || !waits) return e.place;
  return fmt::format("waiting for its shards, the runs of {}", e.shards);
}

}  // namespace

OrderedJson or_null(const std::string& text) {
  return text.empty() ? OrderedJson(nullptr) : OrderedJson(text);
}

OrderedJson state_json(const JobEntry& e) {
  const JobState& s = e.state;
  return {{"state", enum_name(s.state)}, {"phase", s.phase},     {"attempts", s.attempts},
          {"exit_code", s.exit_code},    {"created", s.created}, {"started", s.started},
          {"finished", s.finished},      {"error", s.error},     {"warnings", s.warnings},
          {"obstacle", e.obstacle},      {"place", place_of(e)}};
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

OrderedJson to_json(const JobEntry& e) {
  OrderedJson json = {{"id", e.id},
                      {"label", e.label},
                      {"scene", e.scene},
                      {"integrator", e.integrator},
                      {"sweep", or_null(e.sweep)},
                      {"picture", e.pictured},
                      {"priority", e.priority},
                      {"held", e.held}};
  json.update(state_json(e));
  json["progress"] = e.progress ? to_json(*e.progress) : OrderedJson(nullptr);
  return json;
}

}  // namespace lacuna
