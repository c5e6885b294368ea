#pragma once

#include <string>

#include "analysis/artefacts/record.h"
#include "jobs/run/choice.h"
#include "jobs/run/machine_watch.h"
#include "jobs/run/render_loop.h"
#include "renderer/film/pareto_tail.h"

namespace lacuna {

/// What a job did and what it cost, beside its picture.
struct ReportInput {
  const RenderTask& task;
  const RenderLoop& loop;
  const std::string& camera;  ///< the name of the one that was rendered
  std::vector<std::string> warnings;
  std::vector<ArtefactRecord> artefacts = {};   ///< ArtefactStore::records()
  std::optional<Disturbance> disturbance = {};  ///< while it was rendered
  double started = 0;                           ///< when the job began, on the monotonic clock
  const std::optional<Choice>& choice;          ///< of a job of `auto`: how its method was chosen
};

/// The tail of the squared errors that est_rmse is a mean of; none where too few are known of it.
std::optional<ParetoTail> error_tail(const Film& film);

/// report.json: seconds by phase, counts, rates, what of the scene was built and what was not
/// needed, artefacts built, loaded and left out, errors, memory, machine.
std::string write_report(const ReportInput& input);

}  // namespace lacuna
