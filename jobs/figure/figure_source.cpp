#include "jobs/figure/figure_source.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "jobs/spec/described_json.h"
#include "renderer/film/crop.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

SweepFolder open_sweep(const FigureSpec& spec, const fs::path& folder) {
  const fs::path dir = folder / spec.sweep;
  if (!fs::exists(dir / "sweep.json")) {
    throw BadJob({{"/sweep", fmt::format("found \"{}\", but {} has no sweep.json; allowed: the "
                                         "folder of a sweep, relative to this file",
                                         spec.sweep, dir.string())}});
  }
  return SweepFolder(dir);
}

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
  Finder(const FigureSpec& spec, const SweepPlan& plan, const Answers& answers)
      : spec_(spec), plan_(plan), answers_(answers) {}

  std::vector<FigureRow> run() {
    for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
      check_pointers(spec_.methods[m].settings, fmt::format("/methods/{}/settings", m));
    }
    for (std::size_t s = 0; s < spec_.scenes.size(); ++s) {
      const std::string at = fmt::format("/scenes/{}", s);
      if (!check_pointers(spec_.scenes[s].settings, at + "/settings")) continue;
      if (const auto picture = find_picture(s)) add_row(s, *picture);
    }
    for (std::size_t m = 0; m < spec_.methods.size() && problems_.empty(); ++m) check_used(m);
    throw_if_any(std::move(problems_));
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

  std::optional<std::size_t> find_picture(std::size_t scene) {
    std::vector<std::size_t> found;
    std::vector<std::string> texts;
    for (std::size_t p = 0; p < answers_.pictures.size(); ++p) {
      texts.push_back(answers_.pictures[p].text);
      if (is_of(p, spec_.scenes[scene].settings)) found.push_back(p);
    }
    if (found.size() == 1) return found.front();
    problem(fmt::format("/scenes/{}/settings", scene),
            fmt::format("{} pictures of the sweep have these settings; allowed: settings of one "
                        "of its pictures: \"{}\"",
                        found.empty() ? "no" : std::to_string(found.size()),
                        fmt::join(texts, "\", \"")));
    return {};
  }

  void add_row(std::size_t scene, std::size_t picture) {
    FigureRow row{picture, {}, {}};
    const auto& cells = answers_.pictures[picture].cells;
    row.resolution = plan_.cells[cells.front()].job.resolution;
    for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
      std::vector<std::string> texts;
      auto& cell = row.cells.emplace_back();
      for (const std::size_t c : cells) {
        if (!has(plan_.cells[c], spec_.methods[m].settings)) continue;
        cell = c;
        texts.push_back(cell_text(plan_.cells[c].settings));
      }
      if (texts.size() < 2) continue;
      problem(fmt::format("/methods/{}/settings", m),
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

  const FigureSpec& spec_;
  const SweepPlan& plan_;
  const Answers& answers_;
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
  throw_if_any(std::move(problems));
  return spec;
}

FigureSource::FigureSource(FigureSpec spec, const fs::path& folder)
    : spec_(std::move(spec)), sweep_(open_sweep(spec_, folder)), metrics_(spec_.metrics) {
  CompareAt at = sweep_.spec().compare_at;
  if (spec_.seconds) at.seconds = {*spec_.seconds};
  if (spec_.error) at.errors = {*spec_.error};
  if (metrics_.empty()) {
    answers_.push_back(answer(sweep_, at));
    metrics_.push_back(answers_.front().axes.metric);
  }
  while (answers_.size() < metrics_.size()) {
    at.metric = metrics_[answers_.size()];
    answers_.push_back(answer(sweep_, at));
    at.errors.clear();  // errors of the first metric only
  }
  rows_ = Finder(spec_, sweep_.plan(), answers_.front()).run();
}

const CellAnswer* FigureSource::cell(std::size_t row, std::size_t method,
                                     std::size_t metric) const {
  const auto index = rows_[row].cells[method];
  if (!index) return nullptr;
  const CellAnswer& c = answers_[metric].cells[*index];
  return c.done.empty() ? nullptr : &c;
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

/// The index of the smallest of two or more known values.
std::optional<std::size_t> smallest(const std::vector<std::optional<double>>& values) {
  std::optional<std::size_t> best;
  std::size_t known = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!values[i]) continue;
    ++known;
    if (!best || *values[i] < *values[*best]) best = i;
  }
  return known > 1 ? best : std::nullopt;
}

}  // namespace

std::optional<std::size_t> FigureSource::best_error(std::size_t row, std::size_t metric) const {
  std::vector<std::optional<double>> values;
  for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
    const ErrorAtTime* at = error(row, m, metric);
    values.push_back(at != nullptr && at->error ? std::optional(at->error->value) : std::nullopt);
  }
  return smallest(values);
}

std::optional<std::size_t> FigureSource::best_time(std::size_t row) const {
  std::vector<std::optional<double>> values;
  for (std::size_t m = 0; m < spec_.methods.size(); ++m) {
    const TimeToError* to = time(row, m);
    values.push_back(to != nullptr && to->time ? std::optional(to->time->value) : std::nullopt);
  }
  return smallest(values);
}

}  // namespace lacuna
