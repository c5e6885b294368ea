#include "jobs/figure/figure_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "jobs/report/sweep_pictures.h"
#include "jobs/spec/described_json.h"
#include "renderer/film/crop.h"

namespace lacuna {
namespace {

/// Whether the cell has all of these settings.
bool has(const SweepCell& cell, const JsonTable<JsonValue>& settings) {
  return std::all_of(settings.begin(), settings.end(), [&](const auto& wanted) {
    const auto found = cell.settings.find(wanted.first);
    return found != cell.settings.end() && found->second == wanted.second;
  });
}

/// Finds the pictures and cells that the scenes and methods of a figure name.
class Finder {
 public:
  Finder(FigureSpec& spec, const FigureCells& cells, const Answers& answers)
      : spec_(spec), methods_(cells.methods), plan_(cells.sweep.plan()), answers_(answers) {}

  std::vector<FigureRow> run() {
    for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
      check_pointers(spec_.methods[m].settings, fmt::format("/methods/{}/settings", m));
    }
    for (std::size_t s = 0; s < spec_.scenes.size(); ++s) {
      const std::string at = fmt::format("/scenes/{}", s);
      if (check_pointers(spec_.scenes[s].settings, at + "/settings")) add_rows(s);
    }
    for (std::size_t m = 0; m < spec_.methods.size() && problems_.empty(); ++m) check_used(m);
    throw_if_any(std::move(problems_));
    spec_.scenes = std::move(scenes_);
    return std::move(rows_);
  }

 private:
  void problem(std::string at, std::string message) {
    problems_.push_back({std::move(at), std::move(message)});
  }

  bool check_pointers(const JsonTable<JsonValue>& settings, const std::string& at) {
    const std::size_t before = problems_.size();
    const auto& swept = plan_.cells.front().settings;
    for (const auto& [pointer, value] : settings) {
      if (swept.contains(pointer)) continue;
      std::vector<std::string> names;
      for (const auto& [name, any] : swept) names.push_back(name);
      problem(at, fmt::format("found \"{}\", which the sweep does not vary; allowed: \"{}\"",
                              pointer, fmt::join(names, "\", \"")));
    }
    return problems_.size() == before;
  }

  bool is_of(std::size_t picture, const JsonTable<JsonValue>& settings) const {
    const auto& cells = answers_.pictures[picture].cells;
    return std::all_of(cells.begin(), cells.end(),
                       [&](std::size_t c) { return has(plan_.cells[c], settings); });
  }

  /// A row for each picture with the settings of a scene.
  void add_rows(std::size_t scene) {
    std::vector<std::size_t> found;
    std::vector<std::string> texts;
    for (std::size_t p = 0; p < answers_.pictures.size(); ++p) {
      texts.push_back(answers_.pictures[p].text);
      if (is_of(p, spec_.scenes[scene].settings)) found.push_back(p);
    }
    if (found.empty()) {
      problem(fmt::format("/scenes/{}/settings", scene),
              fmt::format("no picture has these settings; allowed: settings of some of \"{}\"",
                          fmt::join(texts, "\", \"")));
    }
    for (const std::size_t p : found) {
      FigureScene& row = scenes_.emplace_back(spec_.scenes[scene]);
      if (found.size() > 1)
        row.name += texts[p].empty() ? fmt::format(" {}", p + 1) : ", " + texts[p];
      add_row(scene, p);
    }
  }

  void add_row(std::size_t scene, std::size_t picture) {
    FigureRow row{picture, {}, {}};
    const auto& cells = answers_.pictures[picture].cells;
    row.resolution = plan_.cells[cells.front()].job.resolution;
    const auto is_done = [&](std::size_t c) { return !answers_.cells[c].done.empty(); };
    if (std::none_of(cells.begin(), cells.end(), is_done)) {
      problem(fmt::format("/scenes/{}", scene), "no run of this picture is done");
    }
    for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
      std::vector<std::string> texts;
      auto& cell = row.cells.emplace_back();
      for (const std::size_t c : cells) {
        if (!methods_.empty() && methods_[c] != m) continue;
        if (!has(plan_.cells[c], spec_.methods[m].settings)) continue;
        cell = c;
        texts.push_back(cell_text(plan_.cells[c].settings));
      }
      if (texts.size() < 2) continue;
      problem(fmt::format("/methods/{}/{}", m, methods_.empty() ? "settings" : "jobs"),
              fmt::format("{} cells of scene \"{}\" have these settings; allowed: settings of one "
                          "of them: \"{}\"",
                          texts.size(), spec_.scenes[scene].name, fmt::join(texts, "\", \"")));
    }
    check_crops(scene, row);
    rows_.push_back(std::move(row));
  }

  void check_crops(std::size_t scene, const FigureRow& row) {
    const auto& crops = spec_.scenes[scene].crops;
    for (std::size_t i = 0; i < crops.size(); ++i) {
      const auto& [x, y, w, h] = crops[i];
      const std::string at = fmt::format("/scenes/{}/crops/{}", scene, i);
      if (!is_inside({x, y, w, h}, row.resolution[0], row.resolution[1])) {
        problem(at, fmt::format("found {}; allowed: a rectangle inside the picture, {} x {}",
                                crops[i], row.resolution[0], row.resolution[1]));
      } else if (std::int64_t{w} * crops[0][3] != std::int64_t{h} * crops[0][2]) {
        problem(at, fmt::format("found {} x {}; allowed: the aspect ratio of the first, {} x {}", w,
                                h, crops[0][2], crops[0][3]));
      }
    }
  }

  /// A method must have a cell in some scene.
  void check_used(std::size_t method) {
    const bool used = std::any_of(rows_.begin(), rows_.end(), [&](const FigureRow& row) {
      return row.cells[method].has_value();
    });
    if (used) return;
    std::vector<std::string> texts;
    for (const std::size_t c : answers_.pictures[rows_.front().picture].cells) {
      texts.push_back(cell_text(plan_.cells[c].settings));
    }
    problem(fmt::format("/methods/{}/settings", method),
            fmt::format("no cell of these scenes has these settings; allowed: settings of one of "
                        "them: \"{}\"",
                        fmt::join(texts, "\", \"")));
  }

  FigureSpec& spec_;
  const std::vector<std::size_t>& methods_;  // of the cells
  const SweepPlan& plan_;
  const Answers& answers_;
  std::vector<FigureScene> scenes_;  // of the rows
  std::vector<FigureRow> rows_;
  std::vector<Problem> problems_;
};

}  // namespace

FigureSpec parse_figure(std::string_view json) {
  auto spec = read_document<FigureSpec>(json, {max_figure_bytes, 16});
  std::vector<Problem> problems;
  if (spec.error_map && !needs_reference(*spec.error_map)) {
    problems.push_back({"/error_map", fmt::format("found \"{}\"; allowed: a metric that needs a "
                                                  "reference",
                                                  enum_name(*spec.error_map))});
  }
  for (std::size_t m = 0; m < spec.methods.size(); ++m) {
    if (spec.methods[m].jobs.empty() == spec.sweep.has_value()) continue;
    problems.push_back({fmt::format("/methods/{}/jobs", m),
                        spec.sweep ? "found jobs beside \"sweep\"; allowed: one of the two"
                                   : "found none; allowed: jobs, or \"sweep\""});
  }
  throw_if_any(std::move(problems));
  return spec;
}

FigureSource::FigureSource(FigureSpec spec, const std::optional<std::filesystem::path>& folder)
    : spec_(std::move(spec)), cells_(open_cells(spec_, folder)), metrics_(spec_.metrics) {
  CompareAt at = sweep().spec().compare_at;
  if (spec_.seconds) at.seconds = {*spec_.seconds};
  if (spec_.error) at.errors = {*spec_.error};
  if (metrics_.empty()) {
    answers_.push_back(answer(sweep(), at));
    metrics_.push_back(answers_.front().axes.metric);
  }
  while (answers_.size() < metrics_.size()) {
    at.metric = metrics_[answers_.size()];
    answers_.push_back(answer(sweep(), at));
    at.errors.clear();  // errors of the first metric only
  }
  rows_ = Finder(spec_, cells_, answers_.front()).run();
}

const CellAnswer* FigureSource::cell(std::size_t row, std::size_t method,
                                     std::size_t metric) const {
  const auto index = rows_[row].cells[method];
  if (!index) return nullptr;
  const CellAnswer& c = answers_[metric].cells[*index];
  return c.done.empty() ? nullptr : &c;
}

std::optional<std::vector<double>> FigureSource::picture(std::size_t row,
                                                         std::size_t method) const {
  const auto index = rows_[row].cells[method];
  if (!index) return {};
  // Another program's picture may have no time on the clock, and be in no curve.
  const auto is_there = [this](std::size_t run) {
    const RunResult& r = answers().results[run];
    return r.state.state == State::done && r.seconds && !answers().stale.contains(run);
  };
  const auto& runs = answers().cells[*index].runs;
  const auto found = std::ranges::find_if(runs, is_there);
  return found == runs.end() ? std::nullopt : std::optional(read_picture(sweep(), *found));
}

std::optional<Reference> FigureSource::reference(std::size_t row) const {
  std::vector<std::size_t> cells;
  for (const auto& c : rows_[row].cells) {
    if (c) cells.push_back(*c);
  }
  return read_reference_of(sweep(), answers(), cells);
}

const ErrorAtTime* FigureSource::error(std::size_t row, std::size_t method,
                                       std::size_t metric) const {
  const CellAnswer* c = cell(row, method, metric);
  return c == nullptr || c->at.empty() ? nullptr : &c->at.back();
}

const TimeToError* FigureSource::time(std::size_t row, std::size_t method) const {
  const CellAnswer* c = cell(row, method);
  return c == nullptr || c->to.empty() ? nullptr : &c->to.back();
}

namespace {

/// The smallest of two or more known values among `n`, by its index.
template <class ValueOf>
std::optional<std::size_t> smallest(std::size_t n, const ValueOf& value_of) {
  std::optional<std::size_t> best;
  std::size_t known = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::optional<double> value = value_of(i);
    if (!value) continue;
    ++known;
    if (!best || *value < *value_of(*best)) best = i;
  }
  return known > 1 ? best : std::nullopt;
}

}  // namespace

std::optional<std::size_t> FigureSource::best_error(std::size_t row, std::size_t metric) const {
  return smallest(spec_.methods.size(), [&](std::size_t m) {
    const ErrorAtTime* at = error(row, m, metric);
    return at != nullptr && at->error ? std::optional(at->error->value) : std::nullopt;
  });
}

std::optional<std::size_t> FigureSource::best_time(std::size_t row) const {
  return smallest(spec_.methods.size(), [&](std::size_t m) {
    const TimeToError* to = time(row, m);
    return to != nullptr && to->time ? std::optional(to->time->value) : std::nullopt;
  });
}

}  // namespace lacuna
