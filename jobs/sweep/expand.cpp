#include "jobs/sweep/expand.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/sweep/pointer.h"

namespace lacuna {
namespace {

/// Settings that vary together: at each step one value for each pointer.
struct Axis {
  JsonTable<std::vector<JsonValue>> values;
  std::string at;  // in the sweep file
  std::size_t steps = 0;
};

class Expansion {
 public:
  Expansion(const SweepSpec& sweep, const JobCheck& check) : sweep_(sweep), check_(check) {}

  SweepPlan run() {
    gather_axes();
    check_combinations(sweep_.exclude);
    check_values(sweep_.baseline, "/baseline");
    check_positive(sweep_.compare_at.seconds, "/compare_at/seconds");
    check_positive(sweep_.compare_at.errors, "/compare_at/errors");
    check_size();
    throw_if_any(problems_);
    make_cells();
    check_jobs();
    throw_if_any(problems_);
    find_baselines();
    order_runs();
    return std::move(plan_);
  }

 private:
  void problem(std::string at, std::string message) {
    Problem p{std::move(at), std::move(message)};
    if (std::find(problems_.begin(), problems_.end(), p) == problems_.end()) {
      problems_.push_back(std::move(p));
    }
  }

  void gather_axes() {
    for (const auto& [pointer, values] : sweep_.axes) {
      axes_.push_back({{{pointer, values}}, "/axes", values.size()});
    }
    for (std::size_t i = 0; i < sweep_.zip.size(); ++i) {
      Axis axis{sweep_.zip[i], fmt::format("/zip/{}", i), 0};
      if (axis.values.empty()) {
        problem(axis.at, "found no settings; allowed: at least one");
        continue;
      }
      axis.steps = axis.values.begin()->second.size();
      for (const auto& [pointer, values] : axis.values) {
        if (values.size() == axis.steps) continue;
        problem(child_pointer(axis.at, pointer),
                fmt::format("found lists of {} and {}; allowed: lists of equal length",
                            values.size(), axis.steps));
      }
      axes_.push_back(std::move(axis));
    }
    for (const Axis& axis : axes_) {
      for (const auto& [pointer, values] : axis.values) check_axis(axis, pointer, values);
    }
  }

  void check_axis(const Axis& axis, const std::string& pointer,
                  const std::vector<JsonValue>& values) {
    const std::string at = child_pointer(axis.at, pointer);
    if (const auto why = pointer_problem(pointer)) return problem(at, *why);
    if (!axis_of_.emplace(pointer, &axis).second) return problem(at, "is swept twice");
    if (pointer == "/label") problem(at, "is derived from the settings; allowed: other keys");
    if (pointer == "/seed" && sweep_.seeds > 1) {
      problem(at, "is swept by \"seeds\", too; allowed: one of the two");
    }
    if (values.empty()) problem(at, "found no values; allowed: at least one");
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::find(values.begin(), values.begin() + std::ptrdiff_t(i), values[i]) !=
              values.begin() + std::ptrdiff_t(i) &&
          axis.values.size() == 1) {
        problem(fmt::format("{}/{}", at, i), fmt::format("found {} again", values[i].text));
      }
    }
  }

  /// Checks that pointers and values are swept ones.
  void check_values(const JsonTable<JsonValue>& some, const std::string& at) {
    for (const auto& [pointer, value] : some) {
      const auto axis = axis_of_.find(pointer);
      const std::string here = child_pointer(at, pointer);
      if (axis == axis_of_.end()) {
        problem(here, "is not swept; allowed: settings of \"axes\" and \"zip\"");
        continue;
      }
      const auto& values = axis->second->values.at(pointer);
      if (std::find(values.begin(), values.end(), value) == values.end()) {
        problem(here, fmt::format("found {}; allowed: a value that is swept", value.text));
      }
    }
  }
  void check_combinations(const std::vector<JsonTable<JsonValue>>& all) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::string at = fmt::format("/exclude/{}", i);
      if (all[i].empty()) problem(at, "would exclude everything; allowed: at least one setting");
      check_values(all[i], at);
    }
  }
  void check_positive(const std::vector<double>& values, const std::string& at) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] > 0) continue;
      problem(fmt::format("{}/{}", at, i), fmt::format("found {}; allowed: above 0", values[i]));
    }
  }
  void check_size() {
    auto runs = static_cast<std::size_t>(sweep_.seeds);
    for (const Axis& axis : axes_) {
      runs *= std::max<std::size_t>(axis.steps, 1);
      if (runs <= max_sweep_runs) continue;
      return problem("", fmt::format("the sweep has more than {} runs", max_sweep_runs));
    }
  }

  void make_cells() {
    std::vector<std::size_t> step(axes_.size(), 0);
    do {
      SweepCell cell;
      for (std::size_t a = 0; a < axes_.size(); ++a) {
        for (const auto& [pointer, values] : axes_[a].values) {
          cell.settings[pointer] = values[step[a]];
        }
      }
      if (!is_excluded(cell.settings)) plan_.cells.push_back(std::move(cell));
    } while (next(step));
    if (plan_.cells.empty()) problem("/exclude", "excludes all runs");
  }
  bool next(std::vector<std::size_t>& step) const {
    for (std::size_t a = axes_.size(); a-- > 0; step[a] = 0) {
      if (++step[a] < axes_[a].steps) return true;
    }
    return false;
  }
  bool is_excluded(const JsonTable<JsonValue>& settings) const {
    return std::any_of(sweep_.exclude.begin(), sweep_.exclude.end(), [&](const auto& combination) {
      return std::all_of(combination.begin(), combination.end(),
                         [&](const auto& s) { return settings.at(s.first) == s.second; });
    });
  }

  void check_jobs() {
    const Json base = Json(parse_own(sweep_.job.text));
    const Json defaults = Json(parse_own(write_job(JobSpec{})));
    if (!base.is_object()) return problem("/job", "is not an object; allowed: a job");
    for (SweepCell& cell : plan_.cells) {
      Json job = base;
      try {
        // In the order of pointers: a setting before its parts.
        for (const auto& [pointer, value] : cell.settings) {
          if (const auto why = set_at(job, defaults, pointer, Json(parse_own(value.text)))) {
            problem(child_pointer(axis_of_.at(pointer)->at, pointer), *why);
          }
        }
        cell.job = parse_job(json_text(job));
        check_metric(cell.job);
        if (check_) throw_if_any(check_(cell.job));
      } catch (const BadJob& bad) {
        for (const Problem& p : bad.problems()) problem(origin(p.pointer, cell), p.message);
      }
      constexpr std::size_t enough = 200;
      if (problems_.size() > enough) return;
    }
  }
  void check_metric(const JobSpec& job) {
    const auto& metric = sweep_.compare_at.metric;
    if (!metric || !needs_reference(*metric) || !job.reference.empty()) return;
    problem("/compare_at/metric",
            fmt::format("found \"{}\" with a job without \"reference\"; allowed: \"{}\", or a "
                        "reference for all",
                        enum_name(*metric), enum_name(ErrorMetric::est_rmse)));
  }
  /// The position in the sweep file from which a position in a cell's job comes.
  std::string origin(const std::string& at, const SweepCell& cell) const {
    std::string from;
    for (const auto& [pointer, value] : cell.settings) {  // the longest comes last
      if (at == pointer || at.starts_with(pointer + '/')) from = pointer;
    }
    if (from.empty()) return "/job" + at;
    const Axis& axis = *axis_of_.at(from);
    const auto& values = axis.values.at(from);
    const auto i = std::find(values.begin(), values.end(), cell.settings.at(from)) - values.begin();
    return fmt::format("{}/{}{}", child_pointer(axis.at, from), i, at.substr(from.size()));
  }

  void find_baselines() {
    if (sweep_.baseline.empty()) return;
    std::map<JsonTable<JsonValue>, std::size_t> cells;
    for (std::size_t i = 0; i < plan_.cells.size(); ++i) cells[plan_.cells[i].settings] = i;
    for (SweepCell& cell : plan_.cells) {
      auto settings = cell.settings;
      for (const auto& [pointer, value] : sweep_.baseline) settings[pointer] = value;
      const auto found = cells.find(settings);
      if (found != cells.end()) cell.baseline = found->second;
    }
  }

  void order_runs() {
    const auto add = [this](std::size_t cell, int replicate) {
      plan_.runs.push_back({cell, replicate, fmt::format("{:04}-{}", cell + 1, replicate + 1)});
    };
    const auto cells = plan_.cells.size();
    if (sweep_.order == SweepOrder::interleave) {
      for (int r = 0; r < sweep_.seeds; ++r) {
        for (std::size_t c = 0; c < cells; ++c) add(c, r);
      }
    } else {
      for (std::size_t c = 0; c < cells; ++c) {
        for (int r = 0; r < sweep_.seeds; ++r) add(c, r);
      }
    }
    for (SweepCell& cell : plan_.cells) {
      cell.job.exclusive = cell.job.exclusive || sweep_.alone;
      const std::string settings = cell_text(cell.settings);
      cell.job.label = sweep_.label.empty() || settings.empty() ? sweep_.label + settings
                                                                : sweep_.label + ": " + settings;
      constexpr std::size_t longest = 200;
      if (cell.job.label.size() > longest) cell.job.label = sweep_.label;
    }
  }

  const SweepSpec& sweep_;
  const JobCheck& check_;
  std::vector<Axis> axes_;
  std::map<std::string, const Axis*> axis_of_;  // by pointer
  std::vector<Problem> problems_;
  SweepPlan plan_;
};

}  // namespace

JobSpec SweepPlan::job_of(const SweepRun& run) const {
  JobSpec job = cells[run.cell].job;
  job.seed += static_cast<std::uint64_t>(run.replicate);
  return job;
}

SweepSpec parse_sweep(std::string_view json) {
  return read_document<SweepSpec>(json, {max_sweep_bytes, max_json_depth + 4});
}

SweepPlan expand(const SweepSpec& sweep, const JobCheck& check) {
  return Expansion(sweep, check).run();
}

}  // namespace lacuna
