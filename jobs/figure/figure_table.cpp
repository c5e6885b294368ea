#include "jobs/figure/figure_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/figure/page.h"

namespace lacuna {
namespace {

std::string bracketed(std::string text, bool at_floor) {
  return at_floor ? fmt::format("({})", text) : text;
}

FigureTableCell error_cell(const ErrorAtTime* at) {
  if (at == nullptr) return {"–", "", false};
  if (!at->error) return {fmt::format("{} runs", at->reached), "", false};
  return {error_text(*at), figure_interval(*at->error), false};
}

FigureTableCell time_cell(const TimeToError* to) {
  if (to == nullptr) return {"–", "", false};
  if (to->time) {
    const std::string bound = to->at_most ? "≤ " : "";
    return {bracketed(fmt::format("{}{} s", bound, figure_number(to->time->value)), to->at_floor),
            figure_interval(*to->time), false};
  }
  if (to->at_least) return {fmt::format("> {} s", figure_number(*to->at_least)), "", false};
  return {"not reached", "", false};
}

FigureTableCell gain_cell(const std::optional<Gain>& gain) {
  if (!gain) return {"–", "", false};
  return {fmt::format("{}{}×", gain->at_least ? "> " : "", figure_number(gain->ratio.value)),
          gain->at_least ? "" : figure_interval(gain->ratio), false};
}

class TableMaker {
 public:
  explicit TableMaker(const FigureSource& source) : source_(source) {}

  FigureTable run() {
    for (const FigureMethod& m : source_.spec().methods) table_.methods.push_back(m.name);
    for (std::size_t r = 0; r < source_.rows().size(); ++r) {
      for (std::size_t k = 0; k < source_.metrics().size(); ++k) add_errors(r, k);
      add_times(r);
    }
    table_.note = fmt::format(
        "Geometric means over runs with {:.0f} % intervals; {} of rendering; ( ): mostly noise of "
        "the reference.",
        100 * confidence,
        source_.answers().axes.clock == "seconds" ? "seconds" : "CPU seconds over threads");
    return std::move(table_);
  }

 private:
  std::size_t methods() const { return source_.spec().methods.size(); }
  const PictureAnswer& picture(std::size_t row, std::size_t metric) const {
    return source_.answers(metric).pictures[source_.rows()[row].picture];
  }
  void add(std::size_t row, std::string quantity, std::vector<FigureTableCell> cells) {
    table_.rows.push_back({source_.spec().scenes[row].name, std::move(quantity), std::move(cells)});
  }

  void add_errors(std::size_t row, std::size_t metric) {
    const auto& seconds = picture(row, metric).seconds;
    if (seconds.empty()) return;
    std::vector<FigureTableCell> cells;
    for (std::size_t m = 0; m < methods(); ++m) {
      cells.push_back(error_cell(source_.error(row, m, metric)));
    }
    if (const auto best = source_.best_error(row, metric)) cells[*best].best = true;
    add(row,
        fmt::format("{} at {} s", row_of(source_.metrics()[metric]).label,
                    figure_number(seconds.back())),
        std::move(cells));
  }

  void add_times(std::size_t row) {
    const auto& errors = picture(row, 0).errors;
    if (errors.empty()) return;
    std::vector<FigureTableCell> cells, gains;
    bool compared = false;
    for (std::size_t m = 0; m < methods(); ++m) {
      const TimeToError* to = source_.time(row, m);
      cells.push_back(time_cell(to));
      gains.push_back(gain_cell(to == nullptr ? std::nullopt : to->speed_up));
      compared = compared || (to != nullptr && to->speed_up);
    }
    if (const auto best = source_.best_time(row)) cells[*best].best = true;
    add(row,
        fmt::format("time to {} {}", row_of(source_.metrics()[0]).label,
                    figure_number(errors.back())),
        std::move(cells));
    if (compared) add(row, "speed-up over the baseline", std::move(gains));
  }

  const FigureSource& source_;
  FigureTable table_;
};

std::string csv_numbers(const std::optional<Estimate>& e) {
  if (!e) return ",,,";
  if (!e->interval) return fmt::format("{:.17g},,,{}", e->value, e->n);
  return fmt::format("{:.17g},{:.17g},{:.17g},{}", e->value, e->interval->low, e->interval->high,
                     e->n);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

}  // namespace

std::string error_text(const ErrorAtTime& at) {
  return bracketed(figure_number(at.error->value), at.at_floor);
}

FigureTable figure_table(const FigureSource& source) { return TableMaker(source).run(); }

std::string table_markdown(const FigureTable& table) {
  const auto safe = [](const std::string& text) { return replaced(text, "|", "\\|"); };
  std::string text = "| scene | |", rule = "| --- | --- |";
  for (const std::string& m : table.methods) {
    text += fmt::format(" {} |", safe(m));
    rule += " --- |";
  }
  text += '\n' + rule + '\n';
  for (const auto& row : table.rows) {
    text += fmt::format("| {} | {} |", safe(row.scene), row.quantity);
    for (const FigureTableCell& c : row.cells) {
      text += c.best ? fmt::format(" **{}**", c.value) : fmt::format(" {}", c.value);
      text += c.interval.empty() ? " |" : fmt::format(" {} |", c.interval);
    }
    text += '\n';
  }
  return fmt::format("{}\n{}\n", text, table.note);
}

std::string latex_text(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const bool special = std::string_view("&%$#_{}").find(c) != std::string_view::npos;
    safe += c == '\\'  ? "\\textbackslash{}"
            : c == '~' ? "\\textasciitilde{}"
            : c == '^' ? "\\textasciicircum{}"
            : c == '<' ? "$<$"
            : c == '>' ? "$>$"
                       : (special ? "\\" : "") + std::string(1, c);
  }
  constexpr std::array<std::array<const char*, 2>, 16> signs{{{" · ", "$\\cdot$"},
                                                              {"×", "$\\times$"},
                                                              {"≤", "$\\le$"},
                                                              {"–", "--"},
                                                              {"⁻", "$^{-}$"},
                                                              {"⁰", "$^0$"},
                                                              {"¹", "$^1$"},
                                                              {"²", "$^2$"},
                                                              {"³", "$^3$"},
                                                              {"⁴", "$^4$"},
                                                              {"⁵", "$^5$"},
                                                              {"⁶", "$^6$"},
                                                              {"⁷", "$^7$"},
                                                              {"⁸", "$^8$"},
                                                              {"⁹", "$^9$"},
                                                              {"−", "$-$"}}};
  for (const auto& [sign, command] : signs) safe = replaced(safe, sign, command);
  return safe;
}

std::string table_latex(const FigureTable& table) {
  std::string text = fmt::format("\\begin{{tabular}}{{ll{}}}\n\\toprule\n & ",
                                 std::string(table.methods.size(), 'r'));
  for (const std::string& m : table.methods) text += fmt::format(" & {}", latex_text(m));
  text += " \\\\\n\\midrule\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    const bool first = i == 0 || table.rows[i - 1].scene != row.scene;
    if (first && i > 0) text += "\\addlinespace\n";
    text += fmt::format("{} & {}", first ? latex_text(row.scene) : "", latex_text(row.quantity));
    for (const FigureTableCell& c : row.cells) {
      const std::string value = latex_text(c.value);
      text += c.best ? fmt::format(" & \\textbf{{{}}}", value) : fmt::format(" & {}", value);
      if (!c.interval.empty()) text += fmt::format(" {{\\scriptsize {}}}", latex_text(c.interval));
    }
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string table_csv(const FigureSource& source) {
  std::string text = "scene,method,quantity,at,value,low,high,runs,at_most,at_least,supported\n";
  const auto add = [&](std::size_t r, std::size_t m, std::string_view quantity, double at,
                       const std::string& numbers, const std::string& rest) {
    text += fmt::format("{},{},{},{:.17g},{},{}\n", csv_field(source.spec().scenes[r].name),
                        csv_field(source.spec().methods[m].name), quantity, at, numbers, rest);
  };
  for (std::size_t r = 0; r < source.rows().size(); ++r) {
    for (std::size_t m = 0; m < source.spec().methods.size(); ++m) {
      for (std::size_t k = 0; k < source.metrics().size(); ++k) {
        const ErrorAtTime* at = source.error(r, m, k);
        if (at == nullptr) continue;
        add(r, m, enum_name(source.metrics()[k]), at->time, csv_numbers(at->error),
            fmt::format(",,{}", at->at_floor ? 0 : 1));
      }
      const TimeToError* to = source.time(r, m);
      if (to == nullptr) continue;
      add(r, m, "seconds_to_error", to->error, csv_numbers(to->time),
          fmt::format("{},{},{}", to->at_most ? 1 : 0,
                      to->at_least ? fmt::format("{:.17g}", *to->at_least) : "",
                      to->at_floor ? 0 : 1));
    }
  }
  return text;
}

}  // namespace lacuna
