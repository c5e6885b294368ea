#pragma once

#include <string>
#include <vector>

#include "jobs/figure/figure_source.h"

namespace lacuna {

struct FigureTableCell {
  std::string value, interval;
  bool best = false;
};

/// Scenes by methods: for each scene a row for each metric, and one with the time to equal error.
struct FigureTable {
  struct Row {
    std::string scene, quantity;
    std::vector<FigureTableCell> cells;  ///< by method
  };
  std::vector<std::string> methods;
  std::vector<Row> rows;
  std::string note;  ///< what intervals, bounds and brackets mean
};

FigureTable figure_table(const FigureSource& source);

/// The table as Markdown, and as LaTeX (booktabs).
std::string table_markdown(const FigureTable& table);
std::string table_latex(const FigureTable& table);
/// A row for each scene, method and quantity, with all digits (CSV, RFC 4180).
std::string table_csv(const FigureSource& source);

/// An error that is known, with three digits; in brackets if most of it is the reference's noise.
std::string error_text(const ErrorAtTime& at);
/// Text that LaTeX shows as it is; superscripts and "·" become mathematics.
std::string latex_text(const std::string& text);

}  // namespace lacuna
