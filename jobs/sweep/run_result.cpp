#include "jobs/sweep/run_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "base/storage/atomic_file.h"
#include "jobs/spec/json_document.h"
#include "jobs/sweep/limits.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

/// A CSV file of numbers; an empty field is NaN.
class NumberTable {
 public:
  explicit NumberTable(const fs::path& file) : file_(file) {
    std::istringstream text(read_file(file, max_curve_bytes));
    std::string line;
    std::getline(text, line);
    names_ = split(line);
    while (std::getline(text, line)) add(split(line));
  }

  std::size_t rows() const { return rows_.size(); }
  double at(std::size_t row, std::string_view column) const {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i] == column) return rows_[row][i];
    }
    throw std::runtime_error(fmt::format("{} has no column \"{}\"", file_.string(), column));
  }

 private:
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields(1);
    for (const char c : line) {
      if (c == ',') {
        fields.emplace_back();
      } else if (c != '\r') {
        fields.back() += c;
      }
    }
    return fields;
  }
  void add(const std::vector<std::string>& fields) {
    std::vector<double> row;
    for (const std::string& f : fields) {
      double value = std::nan("");
      const auto end = f.data() + f.size();
      if (!f.empty() && std::from_chars(f.data(), end, value).ptr != end) row.clear();
      row.push_back(value);
    }
    if (row.size() != names_.size()) {
      throw std::runtime_error(fmt::format("{}, line {}: not {} numbers", file_.string(),
                                           rows_.size() + 2, names_.size()));
    }
    rows_.push_back(std::move(row));
  }

  fs::path file_;
  std::vector<std::string> names_;
  std::vector<std::vector<double>> rows_;
};

/// The limit of `clock` in a finished job's budget; 0 unless only that limit can have ended it.
double budget_end(const Budget& budget, const std::string& clock) {
  if (budget.iterations || budget.error) return 0;
  if (budget.seconds && budget.cpu_seconds) return 0;
  return (clock == "seconds" ? budget.seconds : budget.cpu_seconds).value_or(0);
}

/// The next picture would have been finished one iteration after the last; and none was finished
/// later within the budget, because the unfinished iteration is discarded at its end.
double held_until(const NumberTable& table, const CurveAxes& axes, const Budget& budget) {
  const std::size_t last = table.rows() - 1;
  const double time = table.at(last, axes.clock), iterations = table.at(last, "iteration");
  const double next = iterations > 0 ? time * (1 + 1 / iterations) : time;
  return std::max(next, budget_end(budget, axes.clock));
}

/// Another program's picture is compared at times within this factor of its own; its squared error
/// is taken to be proportional to 1 / time there.
constexpr double near_in_time = 1.1;

/// The curve of another program's pictures: extended to both sides, because separate runs never
/// take equal times.
ErrorCurve extended(std::vector<CurvePoint> points, ErrorMetric metric) {
  const double rate = row_of(metric).squared ? 1 : .5;
  CurvePoint before = points.front(), after = points.back();
  before.time /= near_in_time, before.error *= std::pow(near_in_time, rate);
  after.time *= near_in_time, after.error /= std::pow(near_in_time, rate);
  const double end = after.time;
  points.insert(points.begin(), before);
  points.push_back(after);
  return {std::move(points), end};
}

void read_curve(const NumberTable& table, const CurveAxes& axes, const Budget& budget,
                RunResult& result) {
  std::vector<CurvePoint> points;
  const bool referenced = needs_reference(axes.metric);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const CurvePoint p{table.at(i, axes.clock), table.at(i, enum_name(axes.metric)),
                       referenced && table.at(i, "at_floor") > 0};
    const bool later = points.empty() || p.time > points.back().time;
    if (p.time > 0 && later && p.error > 0 && std::isfinite(p.error)) points.push_back(p);
  }
  if (points.empty()) return;
  result.end = points.back();
  const bool foreign = std::isnan(table.at(0, "iteration"));
  result.curve = foreign ? extended(std::move(points), axes.metric)
                         : ErrorCurve(std::move(points), held_until(table, axes, budget));
}

double efficiency(const CurvePoint& end, ErrorMetric metric) {
  return 1 / ((row_of(metric).squared ? end.error : end.error * end.error) * end.time);
}

/// A value of a JSON document, by its keys; null if it is missing.
template <class... Keys>
const Json* find(const Json& json, const Keys&... keys) {
  const Json* here = &json;
  const auto enter = [&](const char* key) {
    if (here == nullptr) return;
    const auto found = here->is_object() ? here->find(key) : here->end();
    here = here->is_object() && found != here->end() ? &*found : nullptr;
  };
  (enter(keys), ...);
  return here;
}

template <class... Keys>
std::optional<double> number_at(const Json& json, const Keys&... keys) {
  const Json* found = find(json, keys...);
  return found != nullptr && found->is_number() ? std::optional(found->get<double>())
                                                : std::nullopt;
}

template <class... Keys>
std::optional<std::string> string_at(const Json& json, const Keys&... keys) {
  const Json* found = find(json, keys...);
  return found != nullptr && found->is_string() ? std::optional(found->get<std::string>())
                                                : std::nullopt;
}

std::set<std::string> artefact_names(const Json& report, const char* origin) {
  std::set<std::string> names;
  const Json* artefacts = find(report, "artefacts", origin);
  if (artefacts == nullptr) return names;
  for (const Json& a : *artefacts) {
    const Json* name = find(a, "name");
    if (name != nullptr && name->is_string()) names.insert(name->get<std::string>());
  }
  return names;
}

/// MSE = bias^2 + variance + the reference's noise; the halves estimate only the variance.
void tell_bias(const NumberTable& table, const Json& report, RunResult& result) {
  const std::size_t last = table.rows() - 1;
  const double mse = table.at(last, enum_name(ErrorMetric::mse)),
               deviation = table.at(last, enum_name(ErrorMetric::est_rmse));
  if (!std::isfinite(deviation)) return;
  result.variance = deviation * deviation;
  const auto own = number_at(report, "errors", "reference", "own_rmse");
  if (std::isfinite(mse) && own) result.bias_squared = mse - *result.variance - *own * *own;
}

void read_report(const fs::path& file, Json& report) {
  std::vector<Problem> problems;
  try {
    report = parse_document(read_file(file, max_report_bytes), {max_report_bytes, 64}, problems);
  } catch (const BadJob& bad) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), bad.what()));
  }
  if (!report.is_object()) throw std::runtime_error(file.string() + " contains no report");
}

}  // namespace

RunResult read_result(const JobFolder& folder, const CurveAxes& axes, const Budget& budget) {
  RunResult result;
  result.state = folder.read_state();
  if (auto inputs = read_inputs(folder)) result.inputs = std::move(*inputs);
  Json report = Json::object();
  if (fs::exists(folder.file("report.json"))) {
    read_report(folder.file("report.json"), report);
    if (const auto load = number_at(report, "seconds", "load")) {
      result.preparation = {*load, number_at(report, "seconds", "analysis").value_or(0),
                            artefact_names(report, "built"), artefact_names(report, "loaded")};
    }
    result.camera = string_at(report, "scene", "camera");
    result.reference_file = string_at(report, "errors", "reference", "file");
    result.others = number_at(report, "machine", "others_share");
    result.stolen = number_at(report, "machine", "stolen_share");
    result.mhz = number_at(report, "machine", "mhz");
  }
  if (!fs::exists(folder.file("curve.csv"))) return result;
  const NumberTable table(folder.file("curve.csv"));
  if (table.rows() == 0) return result;
  const bool done = result.state.state == State::done;
  read_curve(table, axes, done ? budget : Budget{}, result);
  if (result.end) result.efficiency = efficiency(*result.end, axes.metric);
  const auto last = [&](const char* column) {
    const double value = table.at(table.rows() - 1, column);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  };
  result.seconds = last("seconds");
  result.cpu_seconds = last("cpu_seconds");
  tell_bias(table, report, result);
  return result;
}

}  // namespace lacuna
