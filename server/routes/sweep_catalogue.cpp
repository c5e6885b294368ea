#include "server/routes/sweep_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "jobs/spec/described_json.h"
#include "server/http/message.h"
#include "server/routes/catalogue.h"

namespace lacuna {
namespace {

double share_done(std::size_t runs, const Counts& counts, const std::vector<JobEntry>& begun) {
  if (runs == 0) return 0;
  auto done = static_cast<double>(all_of(counts) - unfinished_of(counts));
  for (const JobEntry& run : begun) {
    if (run.progress) done += run.progress->share;
  }
  return done / static_cast<double>(runs);
}

OrderedJson cells_json(const SweepPlan& plan) {
  OrderedJson cells = OrderedJson::array();
  for (const SweepCell& cell : plan.cells) {
    OrderedJson settings = OrderedJson::object();
    for (const auto& [pointer, value] : cell.settings) settings[pointer] = parse_own(value.text);
    cells.push_back(
        {{"text", cell_text(cell.settings)},
         {"settings", std::move(settings)},
         {"baseline", cell.baseline ? OrderedJson(*cell.baseline + 1) : OrderedJson(nullptr)}});
  }
  return cells;
}

OrderedJson runs_json(const SweepFolder& folder, const Store& store, bool over) {
  std::map<std::string, State> states;
  for (const JobEntry& job : store.runs(folder.id())) states[job.id] = job.state.state;
  OrderedJson runs = OrderedJson::array();
  for (const SweepRun& run : folder.plan().runs) {
    const std::string id = folder.job_id(run);
    const auto job = states.find(id);
    const bool made = job != states.end();
    OrderedJson state = nullptr;
    if (made || !over) state = enum_name(made ? job->second : State::queued);
    runs.push_back({{"run", run.name},
                    {"job", made ? OrderedJson(id) : OrderedJson(nullptr)},
                    {"cell", run.cell + 1},
                    {"replicate", run.replicate + 1},
                    {"state", std::move(state)}});
  }
  return runs;
}

}  // namespace

SweepEntry find_sweep(const Store& store, const std::string& id) {
  auto sweep = store.find_sweep(id);
  if (!sweep) throw HttpError(404, fmt::format("There is no sweep \"{}\".", id));
  return std::move(*sweep);
}

OrderedJson to_json(const SweepEntry& sweep, const Store& store) {
  Counts counts = store.run_counts(sweep.id);
  const double share = share_done(sweep.runs, counts, store.unfinished_runs(sweep.id));
  if (!is_over(sweep.state)) {  // runs that are not yet jobs
    counts[State::queued] += sweep.runs - std::min(sweep.runs, all_of(counts));
  }
  return {{"id", sweep.id},
          {"label", sweep.label},
          {"state", enum_name(sweep.state)},
          {"created", sweep.created},
          {"finished", sweep.finished},
          {"error", sweep.error},
          {"run_count", sweep.runs},
          {"counts", counts_json(counts)},
          {"share", share}};
}

OrderedJson plan_json(const SweepSpec& spec, const SweepPlan& plan) {
  return {{"spec", parse_own(write_document(spec))},
          {"cell_count", plan.cells.size()},
          {"run_count", plan.runs.size()},
          {"cells", cells_json(plan)}};
}

OrderedJson sweep_detail(const SweepEntry& sweep, const SweepFolder& folder, const Store& store) {
  OrderedJson json = to_json(sweep, store);
  json.update(plan_json(folder.spec(), folder.plan()));
  json["runs"] = runs_json(folder, store, is_over(sweep.state));
  return json;
}

}  // namespace lacuna
