#pragma once

#include <string>
#include <string_view>

#include "analysis/artefacts/record.h"
#include "jobs/run/choice.h"
#include "jobs/run/machine_watch.h"
#include "jobs/run/render_loop.h"
#include "renderer/film/pareto_tail.h"

namespace lacuna {

/// Section of the work in which an `auto` reference is made. Not in the report: it is another
/// job's.
inline constexpr std::string_view reference_section = "reference";

/// The input of a job's report.
struct ReportInput {
  const RenderTask& task;
  const RenderLoop& loop;
  const std::string& camera;  ///< name of the camera used
  std::vector<std::string> warnings;
  std::vector<ArtefactRecord> artefacts = {};   ///< ArtefactStore::records()
  std::optional<Disturbance> disturbance = {};  ///< during rendering
  double started = 0;                           ///< when the job began, on the monotonic clock
  const std::optional<Choice>& choice;          ///< of a job of `auto`: how its method was chosen
};

/// The tail of the squared errors whose mean est_rmse is; none if there are too few of them.
std::optional<ParetoTail> error_tail(const Film& film);

/// report.json: seconds by phase, counts, rates, built and unneeded parts of the scene, artefacts
/// built, loaded and left out, errors, memory, machine.
std::string write_report(const ReportInput& input);

}  // namespace lacuna
