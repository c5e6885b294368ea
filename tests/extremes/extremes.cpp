// Every registered method through every extreme: `dev extremes`, and quickly in `dev test`.
#include <fmt/format.h>

#include <iterator>
#include <string_view>

#include "tests/extremes/matrix.h"
#include "tests/extremes/rows.h"
#include "tests/extremes/watchdog.h"

namespace lacuna::extremes {
namespace {

/// Probability that a run with other seeds raises a false alarm; the seeds are fixed.
constexpr double false_alarm = 1e-4;

std::vector<Row> all_rows(const Effort& effort) {
  std::vector<Row> all;
  for (const auto& group : {scale_rows, light_rows, surface_rows, geometry_rows, accumulation_rows,
                            space_rows, settings_rows, output_rows, budget_rows, input_rows}) {
    std::vector<Row> rows = group(effort);
    std::move(rows.begin(), rows.end(), std::back_inserter(all));
  }
  return all;
}

/// In a quick run each row is put to every integrator with its defaults, and to a sixth of the
/// other columns, to another sixth in the next row.
bool is_left_to_long_runs(const Effort& effort, std::size_t row, std::size_t column,
                          const Method& method) {
  const bool has_choice = method.name.find(' ') != std::string::npos;
  return effort.quick && has_choice && (row + column) % 6 != 0;
}

Verdict verdict(Stage& stage, const Row& row, const Method& method) {
  if (const std::string why = row.left_out(method); !why.empty()) {
    return {.kind = Verdict::Kind::left_out, .why = why};
  }
  Check check;
  try {
    row.run(stage, method, check);
  } catch (const std::exception& e) {
    return {.kind = Verdict::Kind::red, .why = e.what()};
  }
  return check.verdict();
}

int run(bool quick, std::string_view wanted) {
  const Effort effort{quick};
  const std::vector<Method> columns = methods(!quick);
  Matrix matrix(columns);
  Stage stage(effort);
  Watchdog watchdog(std::chrono::seconds(quick ? 600 : 900));
  const std::vector<Row> rows = all_rows(effort);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const Row& row = rows[r];
    if (row.name.find(wanted) == std::string::npos) continue;
    std::vector<Verdict> verdicts;
    double took = 0, longest = 0;  // s
    std::string_view slowest;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (is_left_to_long_runs(effort, r, c, columns[c])) {
        verdicts.push_back({.kind = Verdict::Kind::left_out, .why = "left to ./dev extremes"});
        continue;
      }
      watchdog.begin(row.name + ", " + columns[c].name);
      const auto begin = std::chrono::steady_clock::now();
      verdicts.push_back(verdict(stage, row, columns[c]));
      const std::chrono::duration<double> cell = std::chrono::steady_clock::now() - begin;
      took += cell.count();
      if (cell.count() > longest) {
        longest = cell.count();
        slowest = columns[c].name;
      }
    }
    fmt::print("{:<34} {:7.2f} s, of these {:.2f} s by {}\n", row.name, took, longest, slowest);
    std::fflush(stdout);
    matrix.add_row(row.name, std::move(verdicts));
  }
  matrix.settle(false_alarm);
  fmt::print("\n{}{} passed, {} failed\n", matrix.text(), matrix.passed(), matrix.failed());
  return matrix.failed() == 0 && matrix.passed() > 0 ? 0 : 1;
}

}  // namespace
}  // namespace lacuna::extremes

int main(int argc, char** argv) {
  bool quick = false;
  std::string_view wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--quick") {
      quick = true;
    } else if (argument.starts_with("--row=")) {
      wanted = argument.substr(6);
    } else {
      fmt::print(stderr, "extremes: \"{}\"; allowed: --quick, --row=PART_OF_ITS_NAME\n", argument);
      return 2;
    }
  }
  return lacuna::extremes::run(quick, wanted);
}
