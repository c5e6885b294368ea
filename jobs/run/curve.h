#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/film/metrics.h"
#include "renderer/path/counters.h"

namespace lacuna {

/// The costs and errors of a job at one instant.
struct CurveRow {
  std::uint64_t iteration = 0;          ///< 0: of another program, which counts nothing
  double seconds = 0, cpu_seconds = 0;  ///< render time; CPU divided by threads; NaN: not known
  double longest_seconds = 0;           ///< as in Spent
  Counters counters;
  std::optional<Errors> errors;  ///< against the reference, if there is one
  std::optional<double> flip, est_rmse;
  /// More than half of the measured mse is noise of the reference, so the curve no longer shows the
  /// convergence of the method.
  bool at_floor = false;

  /// The value of `metric` in this row, if it has one.
  std::optional<double> value(ErrorMetric metric) const {
    if (metric == ErrorMetric::flip) return flip;
    if (metric == ErrorMetric::est_rmse) return est_rmse;
    return errors ? std::optional((*errors)[metric]) : std::nullopt;
  }
};

/// Error against time.
class Curve {
 public:
  /// Whether render time `seconds` has reached the next instant at which a row is due: 0.1 s, then
  /// each sqrt(2) times the one before.
  bool due(double seconds) const;
  /// Adds a row; a second one for the same iteration replaces the first.
  void add(const CurveRow& row);
  const std::vector<CurveRow>& rows() const { return rows_; }

  /// The text of curve.csv: a header, then one line for each row. Missing values are empty; numbers
  /// have 17 significant digits.
  std::string csv() const;

  /// For checkpoints. load() throws std::runtime_error on bytes that save() cannot have written.
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  std::vector<CurveRow> rows_;
};

}  // namespace lacuna
