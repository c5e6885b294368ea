#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "jobs/figure/figure_cells.h"
#include "jobs/run/reference.h"
#include "jobs/sweep/answers.h"

namespace lacuna {

/// Parses and validates a figure's file. Throws BadJob.
FigureSpec parse_figure(std::string_view json);

/// A scene of a figure: a picture of the sweep or of the jobs.
struct FigureRow {
  std::size_t picture = 0;  ///< index into Answers::pictures
  /// For each method the cell, as an index into plan().cells; none: the sweep has no such cell.
  std::vector<std::optional<std::size_t>> cells;
  std::array<int, 2> resolution{};
};

/// A figure with the numbers that it shows: those of the sweep's report, computed by the same code.
class FigureSource {
 public:
  /// `folder`: as open_cells(). Throws BadJob with every problem: no such sweep or jobs, scenes or
  /// methods that are no pictures or cells of it or are several, crops outside of the picture; the
  /// exceptions of answer().
  FigureSource(FigureSpec spec, const std::optional<std::filesystem::path>& folder);

  /// With a scene for each row: a scene whose settings several pictures have is one for each.
  const FigureSpec& spec() const { return spec_; }
  const SweepFolder& sweep() const { return cells_.sweep; }
  const std::vector<FigureRow>& rows() const { return rows_; }
  /// The metrics of the figure, at least one.
  const std::vector<ErrorMetric>& metrics() const { return metrics_; }
  /// The answers by the i-th metric.
  const Answers& answers(std::size_t metric = 0) const { return answers_[metric]; }

  /// The answer of a cell; null if the sweep has no such cell or none of its runs is done.
  const CellAnswer* cell(std::size_t row, std::size_t method, std::size_t metric = 0) const;
  /// The picture of a cell's first finished run, and a row's reference. Throw as read_picture().
  std::optional<std::vector<double>> picture(std::size_t row, std::size_t method) const;
  std::optional<Reference> reference(std::size_t row) const;
  /// The error of a cell at the figure's time.
  const ErrorAtTime* error(std::size_t row, std::size_t method, std::size_t metric) const;
  /// The time of a cell to the figure's error.
  const TimeToError* time(std::size_t row, std::size_t method) const;
  /// The methods with the smallest error, and with the shortest time, if there are two or more.
  std::optional<std::size_t> best_error(std::size_t row, std::size_t metric) const;
  std::optional<std::size_t> best_time(std::size_t row) const;

 private:
  FigureSpec spec_;
  FigureCells cells_;
  std::vector<ErrorMetric> metrics_;
  std::vector<Answers> answers_;
  std::vector<FigureRow> rows_;
};

}  // namespace lacuna
