#include "server/routes/sweep_catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "jobs/spec/described_json.h"
#include "server/http/message.h"
#include "server/routes/catalogue.h"

namespace lacuna {
namespace {

double share_done(std::size_t runs, const JobTable::RunCounts& run_counts, const JobTable& jobs) {
  if (runs == 0) return 0;
  auto done = static_cast<double>(run_counts.jobs() - run_counts.unfinished.size());
  for (const std::string& id : run_counts.unfinished) {
    const EntryPtr entry = jobs.find(id);
    if (entry && entry->progress) done += entry->progress->share;
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

OrderedJson runs_json(const SweepFolder& folder, const JobTable& jobs, bool over) {
  OrderedJson runs = OrderedJson::array();
  for (const SweepRun& run : folder.plan().runs) {
    const EntryPtr entry = jobs.find(folder.job_id(run));
    OrderedJson state = nullptr;
    if (entry || !over) state = enum_name(entry ? entry->state.state : State::queued);
    runs.push_back({{"run", run.name},
                    {"job", entry ? OrderedJson(entry->id) : OrderedJson(nullptr)},
                    {"cell", run.cell + 1},
                    {"replicate", run.replicate + 1},
                    {"state", std::move(state)}});
  }
  return runs;
}

}  // namespace

SweepEntryPtr find_sweep(const SweepTable& sweeps, const std::string& id) {
  SweepEntryPtr sweep = sweeps.find(id);
  if (!sweep) throw HttpError(404, fmt::format("There is no sweep \"{}\".", id));
  return sweep;
}

OrderedJson to_json(const SweepEntry& sweep, const JobTable& jobs) {
  JobTable::RunCounts run_counts = jobs.run_counts(sweep.id);
  const double share = share_done(sweep.state.runs, run_counts, jobs);
  if (!is_over(sweep.state.state)) {  // what is no job yet
    run_counts.counts[State::queued] +=
        sweep.state.runs - std::min(sweep.state.runs, run_counts.jobs());
  }
  return {{"id", sweep.id},
          {"label", sweep.label},
          {"state", enum_name(sweep.state.state)},
          {"created", sweep.state.created},
          {"finished", sweep.state.finished},
          {"error", sweep.error},
          {"run_count", sweep.state.runs},
          {"counts", counts_json(run_counts.counts)},
          {"share", share}};
}

OrderedJson plan_json(const SweepSpec& spec, const SweepPlan& plan) {
  return {{"spec", parse_own(write_document(spec))},
          {"cell_count", plan.cells.size()},
          {"run_count", plan.runs.size()},
          {"cells", cells_json(plan)}};
}

OrderedJson sweep_detail(const SweepEntry& sweep, const SweepFolder& folder, const JobTable& jobs) {
  OrderedJson json = to_json(sweep, jobs);
  json.update(plan_json(folder.spec(), folder.plan()));
  json["runs"] = runs_json(folder, jobs, is_over(sweep.state.state));
  return json;
}

}  // namespace lacuna
