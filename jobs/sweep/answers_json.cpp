#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "base/json/number_or_null.h"
#include "jobs/sweep/answers.h"

namespace lacuna {
namespace {

OrderedJson to_json(const Estimate& e) {
  OrderedJson j{{"value", e.value}, {"n", e.n}};
  if (e.interval) {
    j["low"] = e.interval->low;
    j["high"] = e.interval->high;
  }
  return j;
}

OrderedJson to_json(const Gain& gain) {
  OrderedJson j = to_json(gain.ratio);
  if (gain.at_least) j["at_least"] = true;
  return j;
}

OrderedJson to_json(const BreakEven& b) {
  return {{"seconds", b.seconds}, {"from_the_start", b.from_the_start}};
}

template <class T>
OrderedJson optional_json(const std::optional<T>& value) {
  return value ? to_json(*value) : OrderedJson(nullptr);
}

OrderedJson to_json(const ErrorAtTime& at) {
  return {{"seconds", at.time},
          {"reached", at.reached},
          {"error", optional_json(at.error)},
          {"gain", optional_json(at.gain)},
          {"supported", !at.at_floor}};
}

OrderedJson to_json(const TimeToError& to) {
  return {{"error", to.error},
          {"reached", to.reached},
          {"time", optional_json(to.time)},
          {"at_most", to.at_most},
          {"at_least", number_or_null(to.at_least)},
          {"speed_up", optional_json(to.speed_up)},
          {"supported", !to.at_floor}};
}

/// Time, mean, bounds (the mean if there are none), and whether the reference's noise is reached.
OrderedJson to_json(const BandPoint& p) {
  const Interval bounds = p.error.interval.value_or(Interval{p.error.value, p.error.value});
  return {p.time, p.error.value, bounds.low, bounds.high, p.at_floor ? 1 : 0};
}

OrderedJson to_json(const FrontPart& part) {
  OrderedJson tied = OrderedJson::array();
  for (const std::size_t t : part.tied) tied.push_back(t + 1);
  return {{"from", part.from},       {"to", part.to},       {"cell", part.best + 1},
          {"tied", std::move(tied)}, {"error", part.error}, {"supported", !part.at_floor}};
}

template <class T>
OrderedJson list(const std::vector<T>& values) {
  OrderedJson j = OrderedJson::array();
  for (const T& v : values) j.push_back(to_json(v));
  return j;
}

class Writer {
 public:
  Writer(const SweepFolder& sweep, const Answers& answers) : sweep_(sweep), answers_(answers) {}

  OrderedJson document() const {
    OrderedJson j{{"label", sweep_.spec().label},
                  {"metric", enum_name(answers_.axes.metric)},
                  {"clock", answers_.axes.clock},
                  {"confidence", confidence},
                  {"seeds", sweep_.spec().seeds}};
    j["settings"] = OrderedJson::array();  // the pointers that are swept
    if (!sweep_.plan().cells.empty()) {
      for (const auto& [pointer, value] : sweep_.plan().cells.front().settings) {
        j["settings"].push_back(pointer);
      }
    }
    for (const auto& [state, count] : answers_.states) {
      j["states"][std::string(enum_name(state))] = count;
    }
    j["warnings"] = answers_.warnings;
    j["pictures"] = OrderedJson::array();
    for (const PictureAnswer& p : answers_.pictures) j["pictures"].push_back(picture(p));
    j["cells"] = OrderedJson::array();
    for (const CellAnswer& c : answers_.cells) j["cells"].push_back(cell(c));
    return j;
  }

 private:
  static OrderedJson picture(const PictureAnswer& p) {
    OrderedJson cells = OrderedJson::array();
    for (const std::size_t c : p.cells) cells.push_back(c + 1);
    return {
        {"text", p.text},
        {"cells", std::move(cells)},
        {"seconds", p.seconds},
        {"errors", p.errors},
        {"front", {{"render", list(p.render)}, {"warm", list(p.warm)}, {"cold", list(p.cold)}}}};
  }

  OrderedJson run(std::size_t index) const {
    const SweepRun& r = sweep_.plan().runs[index];
    OrderedJson j{{"name", r.name},
                  {"job", sweep_.folder(r).id()},
                  {"seed", sweep_.plan().job_of(r).seed},
                  {"state", enum_name(answers_.results[index].state.state)}};
    if (const auto& end = answers_.results[index].end) {
      j["seconds"] = end->time;
      j["error"] = end->error;
    }
    const auto tainted = std::find_if(answers_.tainted.begin(), answers_.tainted.end(),
                                      [&](const Tainted& t) { return t.run == index; });
    if (tainted != answers_.tainted.end()) j["tainted"] = tainted->why;
    return j;
  }

  OrderedJson cell(const CellAnswer& c) const {
    const SweepCell& planned = sweep_.plan().cells[c.cell];
    OrderedJson j{{"cell", c.cell + 1}, {"text", cell_text(planned.settings)}};
    j["settings"] = OrderedJson::object();
    for (const auto& [pointer, value] : planned.settings) {
      j["settings"][pointer] = parse_own(value.text);
    }
    j["picture"] = c.picture + 1;
    j["baseline"] = planned.baseline ? OrderedJson(*planned.baseline + 1) : OrderedJson(nullptr);
    j["runs"] = OrderedJson::array();
    for (const std::size_t r : c.runs) j["runs"].push_back(run(r));
    j["done"] = c.done.size();
    j["curve"] = list(c.curve);
    j["at"] = list(c.at);
    j["to"] = list(c.to);
    j["efficiency"] = optional_json(c.efficiency);
    j["efficiency_gain"] = optional_json(c.efficiency_gain);
    j["bias_squared"] = optional_json(c.bias_squared);
    j["bias_between_runs"] = optional_json(c.bias_between_runs);
    j["variance"] = optional_json(c.variance);
    j["preparation"] = {{"cold", number_or_null(c.preparation.cold)},
                        {"warm", number_or_null(c.preparation.warm)}};
    j["pays"] = {{"cold", optional_json(c.pays.cold)}, {"warm", optional_json(c.pays.warm)}};
    return j;
  }

  const SweepFolder& sweep_;
  const Answers& answers_;
};

}  // namespace

std::string answers_text(const SweepFolder& sweep, const Answers& answers) {
  return json_text(Writer(sweep, answers).document());
}

}  // namespace lacuna
