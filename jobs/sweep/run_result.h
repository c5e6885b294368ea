#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "jobs/spec/job_spec.h"
#include "jobs/store/inputs.h"
#include "jobs/store/job_folder.h"
#include "jobs/sweep/error_curve.h"
#include "renderer/settings/error_metrics.h"

namespace lacuna {

/// The columns of a curve that are compared.
struct CurveAxes {
  ErrorMetric metric;
  std::string clock;  ///< "seconds" or "cpu_seconds"
};

/// The time of a finished run before its first iteration, seconds.
struct RunPreparation {
  double load = 0;
  double analysis = 0;
  std::set<std::string> built, loaded;  ///< artefacts, by type
};

/// The results in a run's folder, for comparison with other runs; missing values are empty.
struct RunResult {
  JobState state;
  ErrorCurve curve;
  /// The last row with an error: that of the curve, unless it is extended (another program's).
  std::optional<CurvePoint> end;
  std::optional<double> seconds, cpu_seconds;  ///< render time by both clocks, at the last row
  std::optional<double> efficiency;            ///< 1 / (squared error x seconds) at its end
  std::optional<double> bias_squared;          ///< of the last row, less the reference's noise
  std::optional<double> variance;              ///< likewise, from the two halves
  std::optional<RunPreparation> preparation;
  std::optional<std::string> camera;  ///< the one rendered, also where the job names none
  std::optional<std::string> reference_file;
  std::optional<double> others,
      stolen;  ///< shares of the processors' time (jobs/run/machine_watch.h)
  std::optional<double> mhz;
  InputList inputs;  ///< its input files; empty: not recorded
};

/// Reads curve.csv and report.json of a folder, if they exist. `budget`: of its job. Squared errors
/// are those of the metric (squared metrics as they are, others squared). Throws std::runtime_error
/// that names a damaged file.
RunResult read_result(const JobFolder& folder, const CurveAxes& axes, const Budget& budget);

}  // namespace lacuna
