#include "jobs/report/report_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacuna {
namespace {

std::string interval(const Estimate& e) {
  std::string text = fmt::format("{:.3g}", e.value);
  if (e.interval) text += fmt::format(" [{:.3g}, {:.3g}]", e.interval->low, e.interval->high);
  return text;
}

std::string gain_text(const std::optional<Gain>& gain) {
  if (!gain) return "-";
  return fmt::format("{}{}x", gain->at_least ? "> " : "", interval(gain->ratio));
}

/// Parenthesises values at the reference's noise.
std::string supported(const std::string& text, bool at_floor) {
  return at_floor ? "(" + text + ")" : text;
}

std::string error_text(const ErrorAtTime& at, std::size_t runs) {
  if (at.error) return supported(interval(*at.error), at.at_floor);
  return fmt::format("{} of {} runs", at.reached, runs);
}

std::string time_text(const TimeToError& to, std::size_t runs) {
  if (to.time) return supported((to.at_most ? "<= " : "") + interval(*to.time), to.at_floor);
  if (to.reached > 0) return fmt::format("{} of {} runs", to.reached, runs);
  return to.at_least ? fmt::format("not in {:.3g}", *to.at_least) : "not reached";
}

/// The name of a cell among those of its picture.
std::string name_of(const SweepFolder& sweep, const PictureAnswer& p, std::size_t cell) {
  const auto& settings = sweep.plan().cells[cell].settings;
  JsonTable<JsonValue> own;
  for (const std::string& pointer : settings_that_vary(sweep.plan(), p.cells).vary) {
    own[pointer] = settings.at(pointer);
  }
  const std::string text = cell_text(own);
  return text.empty() ? "the job" : text;
}

std::string front_text(const SweepFolder& sweep, const PictureAnswer& p) {
  std::string text;
  for (const FrontPart& part : p.cold) {
    text +=
        fmt::format("  {:.3g} to {:.3g} s: {}", part.from, part.to, name_of(sweep, p, part.best));
    if (!part.tied.empty()) text += fmt::format(" (tied with {} more)", part.tied.size());
    text += part.at_floor ? ", at the reference's noise\n" : "\n";
  }
  return text;
}

using TextRow = std::vector<std::string>;

/// Aligns columns; the first two to the right.
std::string columns_text(const std::vector<TextRow>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const TextRow& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const TextRow& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += i < 2 ? fmt::format("  {:>{}}", row[i], widths[i])
                    : fmt::format("  {:<{}}", row[i], widths[i]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
  }
  return text;
}

std::string cells_text(const SweepFolder& sweep, const Answers& answers, const PictureAnswer& p) {
  if (p.seconds.empty() && p.errors.empty()) return "  no run is done\n";
  const auto heading = [](const char* what, const std::vector<double>& at) {
    return at.empty() ? std::string("-") : fmt::format("{} {:.3g}", what, at.back());
  };
  std::vector<TextRow> rows{{"CELL", "RUNS", heading("ERROR AT", p.seconds), "GAIN",
                             heading("SECONDS TO", p.errors), "SPEED-UP", "SETTINGS"}};
  for (const std::size_t c : p.cells) {
    const CellAnswer& cell = answers.cells[c];
    const bool at = !cell.at.empty(), to = !cell.to.empty();
    rows.push_back({std::to_string(c + 1), fmt::format("{}/{}", cell.done.size(), cell.runs.size()),
                    at ? error_text(cell.at.back(), cell.done.size()) : "-",
                    at ? gain_text(cell.at.back().gain) : "-",
                    to ? time_text(cell.to.back(), cell.done.size()) : "-",
                    to ? gain_text(cell.to.back().speed_up) : "-", name_of(sweep, p, c)});
  }
  return columns_text(rows);
}

}  // namespace

std::string report_text(const SweepFolder& sweep, const Answers& answers) {
  std::string text = fmt::format("{}: {}, {:.0f} % intervals\n", answers.axes.clock,
                                 enum_name(answers.axes.metric), 100 * confidence);
  for (const PictureAnswer& p : answers.pictures) {
    text += fmt::format("\n{}\n", p.text.empty() ? "all cells" : p.text);
    const bool prepared = !p.cold.empty();
    text += prepared ? "lowest error, preparation (cold) included:\n" : "";
    text += front_text(sweep, p);
    text += cells_text(sweep, answers, p);
  }
  for (const std::string& w : answers.warnings) text += "warning: " + w + "\n";
  return text;
}

}  // namespace lacuna
