#include "jobs/sweep/answers.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/storage/passing_error.h"
#include "jobs/spec/identity.h"
#include "jobs/spec/reference_spec.h"
#include "jobs/sweep/compare_points.h"
#include "jobs/sweep/preparation.h"
#include "jobs/sweep/stale_runs.h"
#include "jobs/sweep/taint.h"

namespace lacuna {
namespace {

/// The metric of the sweep, or the default for cells with or without references.
ErrorMetric chosen_metric(const SweepFolder& sweep, const CompareAt& at) {
  if (at.metric) return *at.metric;
  const auto& cells = sweep.plan().cells;
  const bool referenced = std::all_of(cells.begin(), cells.end(),
                                      [](const SweepCell& c) { return !c.job.reference.empty(); });
  return usual_metric(referenced);
}

class Comparison {
 public:
  Comparison(const SweepFolder& sweep, const CompareAt& at)
      : sweep_(sweep), at_(at), plan_(sweep.plan()) {}

  Answers run() {
    answers_.axes = {chosen_metric(sweep_, at_), std::string(enum_name(at_.clock))};
    read();
    answers_.stale = stale_runs(answers_.results);
    gather_cells();
    gather_pictures();
    for (PictureAnswer& p : answers_.pictures) choose_points(p);
    for (CellAnswer& c : answers_.cells) compare(c);
    for (CellAnswer& c : answers_.cells) prepare(c);
    for (CellAnswer& c : answers_.cells) pay_off(c);
    for (PictureAnswer& p : answers_.pictures) find_front(p);
    answers_.tainted = tainted_runs(answers_.results);
    warn();
    return std::move(answers_);
  }

 private:
  void read() {
    for (const SweepRun& run : plan_.runs) {
      answers_.results.push_back(read(run));
      ++answers_.states[answers_.results.back().state.state];
    }
  }

  /// Reports a run whose folder is damaged and excludes only that run.
  RunResult read(const SweepRun& run) {
    try {
      return read_result(sweep_.folder(run), answers_.axes, plan_.cells[run.cell].job.budget);
    } catch (const std::runtime_error& error) {
      if (may_pass(error)) throw;
      answers_.warnings.push_back(fmt::format(
          "run {} is excluded because its folder is damaged: {}", run.name, error.what()));
      RunResult damaged;
      damaged.state.state = State::failed;
      return damaged;
    }
  }

  bool counts(std::size_t run) const {
    const RunResult& r = answers_.results[run];
    return r.state.state == State::done && !r.curve.empty() && !answers_.stale.contains(run);
  }

  void gather_cells() {
    answers_.cells.resize(plan_.cells.size());
    curves_.resize(plan_.cells.size());
    for (std::size_t c = 0; c < plan_.cells.size(); ++c) answers_.cells[c].cell = c;
    for (std::size_t r = 0; r < plan_.runs.size(); ++r) {
      CellAnswer& cell = answers_.cells[plan_.runs[r].cell];
      cell.runs.push_back(r);
      if (!counts(r)) continue;
      cell.done.push_back(r);
      curves_[cell.cell].push_back(answers_.results[r].curve);
    }
  }

  /// The name of each scene's first camera, which jobs without a camera render, from the reports of
  /// such runs.
  std::map<std::string, std::string> first_cameras() const {
    std::map<std::string, std::string> first;
    for (std::size_t r = 0; r < plan_.runs.size(); ++r) {
      const JobSpec& job = plan_.cells[plan_.runs[r].cell].job;
      const std::optional<std::string>& rendered = answers_.results[r].camera;
      if (job.camera.is_default() && rendered) first.emplace(job.scene, *rendered);
    }
    return first;
  }

  void gather_pictures() {
    const std::map<std::string, std::string> first = first_cameras();
    std::map<std::string, std::size_t> known;
    for (CellAnswer& cell : answers_.cells) {
      JobSpec job = plan_.cells[cell.cell].job;
      const auto named = first.find(job.scene);
      if (job.camera.is_default() && named != first.end()) job.camera.name = named->second;
      const auto [found, is_new] = known.emplace(picture_name(job), answers_.pictures.size());
      if (is_new) answers_.pictures.emplace_back();
      cell.picture = found->second;
      answers_.pictures[cell.picture].cells.push_back(cell.cell);
    }
    for (PictureAnswer& p : answers_.pictures) {
      p.text = cell_text(settings_that_vary(plan_, p.cells).shared);
    }
  }

  std::vector<Replicates> replicates(const PictureAnswer& p) const {
    std::vector<Replicates> all;
    for (const std::size_t c : p.cells) {
      if (!curves_[c].empty()) all.emplace_back(curves_[c]);
    }
    return all;
  }

  void choose_points(PictureAnswer& p) {
    const auto all = replicates(p);
    p.seconds = at_.seconds.empty() ? natural_times(all) : at_.seconds;
    p.errors = at_.errors.empty() ? natural_errors(all) : at_.errors;
    std::sort(p.seconds.begin(), p.seconds.end());
    std::sort(p.errors.begin(), p.errors.end(), std::greater<>());
  }

  /// The curves of a cell's baseline; empty if it has none of the same picture.
  Replicates baseline_of(const CellAnswer& cell) const {
    const auto base = plan_.cells[cell.cell].baseline;
    if (!base || *base == cell.cell || answers_.cells[*base].picture != cell.picture) return {};
    return curves_[*base];
  }

  /// A quantity of all finished runs of a cell that have it.
  std::vector<double> values(const CellAnswer& cell, std::optional<double> RunResult::*what) const {
    std::vector<double> found;
    for (const std::size_t r : cell.done) {
      if (const auto& value = answers_.results[r].*what) found.push_back(*value);
    }
    return found;
  }

  void compare(CellAnswer& cell) {
    const Replicates own = curves_[cell.cell], base = baseline_of(cell);
    const PictureAnswer& picture = answers_.pictures[cell.picture];
    if (own.empty()) return;
    cell.curve = mean_curve(own);
    for (const double t : picture.seconds) cell.at.push_back(error_at_time(own, base, t));
    for (const double e : picture.errors) cell.to.push_back(time_to_error(own, base, e));
    const auto efficiencies = values(cell, &RunResult::efficiency);
    if (!efficiencies.empty()) {
      cell.efficiency = geometric_mean(efficiencies);
      if (!base.empty()) {
        const CellAnswer& other = answers_.cells[*plan_.cells[cell.cell].baseline];
        const auto others = values(other, &RunResult::efficiency);
        if (!others.empty()) cell.efficiency_gain = Gain{ratio_of_means(efficiencies, others)};
      }
    }
    const auto bias = values(cell, &RunResult::bias_squared);
    if (!bias.empty()) cell.bias_squared = mean(bias);
    const auto variance = values(cell, &RunResult::variance);
    if (!variance.empty()) cell.variance = mean(variance);
  }

  std::vector<const RunResult*> finished(const CellAnswer& cell) const {
    std::vector<const RunResult*> runs;
    for (const std::size_t r : cell.done) runs.push_back(&answers_.results[r]);
    return runs;
  }

  const std::vector<const RunResult*>& same_space(std::size_t cell) {
    if (spaces_.empty()) {
      for (const CellAnswer& c : answers_.cells) {
        const auto runs = finished(c);
        auto& all = spaces_[preparation_key(plan_.cells[c.cell].job)];
        all.insert(all.end(), runs.begin(), runs.end());
      }
    }
    return spaces_[preparation_key(plan_.cells[cell].job)];
  }

  void prepare(CellAnswer& cell) {
    if (cell.done.empty()) return;
    cell.preparation = preparation(finished(cell), same_space(cell.cell));
  }

  /// Requires prepare() of all cells.
  void pay_off(CellAnswer& cell) {
    const Replicates base = baseline_of(cell);
    if (cell.done.empty() || base.empty()) return;
    const Preparation& theirs = answers_.cells[*plan_.cells[cell.cell].baseline].preparation;
    const auto pays = [&](std::optional<double> mine, std::optional<double> its) {
      return mine && its ? break_even({curves_[cell.cell], *mine}, {base, *its}) : std::nullopt;
    };
    cell.pays = {pays(cell.preparation.cold, theirs.cold),
                 pays(cell.preparation.warm, theirs.warm)};
  }

  /// `charge` null: no preparation.
  std::vector<FrontPart> front(const PictureAnswer& p, std::optional<double> Preparation::*charge) {
    std::vector<Contender> contenders;
    std::vector<std::size_t> cell_of;
    for (const std::size_t c : p.cells) {
      const auto cost = charge == nullptr ? 0.0 : answers_.cells[c].preparation.*charge;
      if (!cost || curves_[c].empty()) continue;
      contenders.push_back({curves_[c], *cost});
      cell_of.push_back(c);
    }
    auto parts = pareto_front(contenders);
    for (FrontPart& part : parts) {
      part.best = cell_of[part.best];
      for (std::size_t& t : part.tied) t = cell_of[t];
    }
    return parts;
  }
  void find_front(PictureAnswer& p) {
    p.render = front(p, nullptr);
    p.warm = front(p, &Preparation::warm);
    p.cold = front(p, &Preparation::cold);
  }

  void warn() {
    auto& w = answers_.warnings;
    const auto unfinished = plan_.runs.size() - answers_.states[State::done];
    if (unfinished > 0) {
      w.push_back(fmt::format("{} of {} runs are not done: results are provisional", unfinished,
                              plan_.runs.size()));
    }
    if (!answers_.stale.empty()) {
      const auto& [run, change] = *answers_.stale.begin();
      w.push_back(
          fmt::format("{} of {} runs have other input files than the latest run and are excluded "
                      "(such as {}: {}): `lacuna sweep` renders runs with changed files again",
                      answers_.stale.size(), plan_.runs.size(), plan_.runs[run].name, change));
    }
    if (sweep_.spec().seeds == 1) {
      w.emplace_back("one seed per cell gives no intervals; set \"seeds\" to 3 or more");
    }
    warn_of_missing_times();
    hint_at_seeds();
    if (!answers_.tainted.empty()) {
      const bool wall = at_.clock == SweepClock::seconds;
      w.push_back(fmt::format("{} of {} runs were timed under other load on the machine{}",
                              answers_.tainted.size(), plan_.runs.size(),
                              wall ? "; compare_at.clock \"cpu_seconds\" is less affected" : ""));
    }
  }

  void warn_of_missing_times() {
    const auto has_none = [&](std::size_t run) {
      const RunResult& r = answers_.results[run];
      return r.state.state == State::done && r.seconds && !r.cpu_seconds;
    };
    if (at_.clock == SweepClock::seconds) return;
    std::vector<std::string> names;
    for (std::size_t r = 0; r < plan_.runs.size(); ++r) {
      if (has_none(r)) names.push_back(plan_.runs[r].name);
    }
    if (names.empty()) return;
    answers_.warnings.push_back(
        fmt::format("{} of {} runs (such as {}) have no CPU seconds and are not compared: give "
                    "their pictures \"cpu_seconds\", or set compare_at.clock to \"seconds\"",
                    names.size(), plan_.runs.size(), names.front()));
  }

  /// Warns of the number of seeds that would halve the intervals, if the widest error interval
  /// spans a factor of two.
  void hint_at_seeds() {
    constexpr double wide = 2;
    double widest = 1;
    std::size_t seeds = 0;
    for (const CellAnswer& cell : answers_.cells) {
      for (const ErrorAtTime& at : cell.at) {
        if (!at.error || !at.error->interval) continue;
        const double span = at.error->interval->high / at.error->interval->low;
        if (span <= widest) continue;
        widest = span;
        seeds = at.error->n;
      }
    }
    if (widest < wide) return;
    answers_.warnings.push_back(
        fmt::format("{} seeds: intervals of errors span up to a factor of {:.2g}; about {} seeds "
                    "would halve them (in the logarithm)",
                    seeds, widest, samples_for_half(seeds)));
  }

  const SweepFolder& sweep_;
  const CompareAt& at_;
  const SweepPlan& plan_;
  std::vector<std::vector<ErrorCurve>> curves_;  // of each cell's finished runs
  std::map<std::string, std::vector<const RunResult*>> spaces_;
  Answers answers_;
};

}  // namespace

Answers answer(const SweepFolder& sweep) { return answer(sweep, sweep.spec().compare_at); }
Answers answer(const SweepFolder& sweep, const CompareAt& at) {
  return Comparison(sweep, at).run();
}

}  // namespace lacuna
