#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/json/json_text.h"
#include "base/storage/atomic_file.h"
#include "base/storage/passing_error.h"
#include "jobs/sweep/limits.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

namespace {

/// A setting as a field: a string without its quotes.
std::string field(const JsonValue& value) {
  const OrderedJson v = parse_own(value.text);
  return csv_field(v.is_string() ? v.get<std::string>() : value.text);
}

/// Flattens the values in an object, at any depth, with keys joined by '.'.
void flatten(const std::string& name, const OrderedJson& value, JsonTable<std::string>& flat) {
  for (const auto& [key, inner] : value.items()) {
    const std::string below = fmt::format("{}.{}", name, key);
    if (inner.is_object()) {
      flatten(below, inner, flat);
    } else {
      flat[below] = inner.is_string() ? inner.get<std::string>() : json_text(inner);
    }
  }
}

/// The settings of a cell that are in objects.
JsonTable<std::string> flat_settings(const SweepCell& cell) {
  JsonTable<std::string> flat;
  for (const auto& [pointer, value] : cell.settings) {
    const OrderedJson v = parse_own(value.text);
    if (v.is_object()) flatten(pointer, v, flat);
  }
  return flat;
}

/// The names of flat_settings() of all cells.
std::vector<std::string> flat_columns(const SweepPlan& plan) {
  std::set<std::string> names;
  for (const SweepCell& cell : plan.cells) {
    for (const auto& [name, value] : flat_settings(cell)) names.insert(name);
  }
  return {names.begin(), names.end()};
}

/// The state of a run; "damaged" if its folder is.
std::string state_name(const SweepFolder& sweep, const SweepRun& run) {
  try {
    return std::string(enum_name(sweep.state(run).state));
  } catch (const std::runtime_error& error) {
    if (may_pass(error)) throw;
    return "damaged";
  }
}

}  // namespace

std::string sweep_table(const SweepFolder& sweep) {
  std::string header, rows;
  const std::vector<std::string> flat = flat_columns(sweep.plan());
  for (const SweepRun& run : sweep.plan().runs) {
    const std::filesystem::path file = sweep.folder(run).file("curve.csv");
    if (!std::filesystem::exists(file)) continue;
    const SweepCell& cell = sweep.plan().cells[run.cell];
    std::string start =
        fmt::format("{},{},{},{},{},{}", run.name, run.cell + 1,
                    cell.baseline ? std::to_string(*cell.baseline + 1) : "", run.replicate + 1,
                    sweep.plan().job_of(run).seed, state_name(sweep, run));
    for (const auto& [pointer, value] : cell.settings) start += ',' + field(value);
    const JsonTable<std::string> own = flat_settings(cell);
    for (const std::string& name : flat) {
      const auto found = own.find(name);
      start += ',' + (found != own.end() ? csv_field(found->second) : "");
    }
    std::istringstream curve(read_file(file, max_curve_bytes));
    std::string line;
    std::getline(curve, line);
    if (header.empty()) {
      header = "run,cell,baseline,replicate,seed,state";
      for (const auto& [pointer, value] : cell.settings) header += ',' + csv_field(pointer);
      for (const std::string& name : flat) header += ',' + csv_field(name);
      header += ',' + line + '\n';
    }
    while (std::getline(curve, line))
      rows.append(start).append(1, ',').append(line).append(1, '\n');
  }
  return header + rows;
}

}  // namespace lacuna
