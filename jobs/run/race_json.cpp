#include "jobs/run/race_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace lacuna {

namespace {

OrderedJson finite(double v) { return std::isfinite(v) ? OrderedJson(v) : OrderedJson(nullptr); }

/// Ratio of errors with the interval of two standard deviations.
OrderedJson ratio(double value, double deviation) {
  return {{"ratio", finite(std::exp(value))},
          {"low", finite(std::exp(value - 2 * deviation))},
          {"high", finite(std::exp(value + 2 * deviation))}};
}

OrderedJson candidate_json(const RaceRecord::Candidate& c) {
  OrderedJson j{{"name", c.name}, {"in_use", c.share > 0}};
  if (c.reason.empty()) {
    j["left"] = nullptr;
  } else {
    j["left"] = {{"round", c.left_in}, {"reason", c.reason}};
  }
  j["iterations"] = c.iterations;
  j["cost"] = c.cost;
  j["preparation_seconds"] = c.preparation;
  if (c.standing.error > 0) {
    j["mse_times_cost"] = c.standing.error;
    j["over_best"] = ratio(c.standing.over_best.value, c.standing.over_best.deviation);
    j["growth"] = c.standing.growth;
    j["spread"] = c.standing.spread;
    const auto tail = c.standing.tail_known;
    j["tail_known"] = tail ? OrderedJson(*tail) : OrderedJson(nullptr);
    j["unexplained"] = c.standing.unexplained;
    if (c.biased) {
      j["bias_rmse"] = std::sqrt(c.standing.bias);
      j["bias_known"] = c.standing.bias > 2 * c.standing.bias_deviation;
    }
  }
  return j;
}

/// The budget from which on a candidate whose preparation takes longer would have been best,
/// seconds: errors fall as one over what preparation leaves.
OrderedJson break_even(const RaceRecord& race) {
  const RaceRecord::Candidate* used = nullptr;
  for (const auto& c : race.candidates) {
    if (c.share > 0 && (used == nullptr || c.standing.error < used->standing.error)) used = &c;
  }
  OrderedJson list = OrderedJson::array();
  if (used == nullptr || !race.seconds) return list;
  for (const auto& c : race.candidates) {
    const double a = used->standing.error, b = c.standing.error;
    if (&c == used || !(b > 0) || !(a > 0) || !(a < b) || used->preparation <= c.preparation)
      continue;
    // a / (t - used) = b / (t - c)
    const double t = (b * used->preparation - a * c.preparation) / (b - a);
    // In less time than the race takes there is nothing to choose.
    if (t < race.spent) continue;
    list.push_back({{"below_seconds", t}, {"better", c.name}});
  }
  return list;
}

}  // namespace

OrderedJson race_json(const RaceRecord& race) {
  OrderedJson j{{"clock", race.seconds ? "cpu_seconds" : "rays"},
                {"spent", race.spent},
                {"reduction", race.reduction},
                {"limit", finite(race.limit)}};
  for (const auto& c : race.candidates) j["candidates"].push_back(candidate_json(c));
  j["rounds"] = OrderedJson::array();
  for (const RaceRow& r : race.rows) {
    OrderedJson row{{"round", r.round},
                    {"candidate", race.candidates[r.entrant].name},
                    {"iterations", r.iterations},
                    {"cost", r.cost},
                    {"mse_times_cost", r.error}};
    row.update(ratio(r.log_ratio, r.deviation));
    j["rounds"].push_back(row);
  }
  const double rest = race.budget - race.spent;
  j["plan"] = {{"mse_times_cost", race.error},
               {"over_best_alone", race.gain},
               {"expected_rmse", race.budget > 0 && rest > 0 && race.error > 0
                                     ? OrderedJson(std::sqrt(race.error / rest))
                                     : OrderedJson(nullptr)}};
  j["break_even"] = break_even(race);
  if (!race.blocks.empty()) {
    j["blocks"] = {{"pixels", race.block}, {"across", race.across}, {"candidate", race.blocks}};
  }
  if (!race.samples.empty()) {
    j["samples"] = {{"pixels", race.block}, {"across", race.across}, {"iterations", race.samples}};
  }
  return j;
}

}  // namespace lacuna
