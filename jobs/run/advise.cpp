#include "jobs/run/advise.h"

#include "jobs/run/choosing.h"
#include "jobs/run/prepare.h"
#include "renderer/integrators/integrator.h"

namespace lacuna {

JobSpec with_auto_integrator(JobSpec spec) {
  if (std::holds_alternative<AutoSettings>(spec.integrator)) return spec;
  AutoSettings choosing;
  std::visit(
      [&]<class S>(const S& s) {
        if constexpr (std::is_base_of_v<PathLengths, S>) static_cast<PathLengths&>(choosing) = s;
      },
      spec.integrator);
  spec.integrator = choosing;
  return spec;
}

Choice advise(const JobFolder& folder, const RunContext& context) {
  const JobSpec spec = folder.read_job();
  const Prepared prepared = prepare(spec, context);
  for (const std::string& w : prepared.warnings) context.observer.warning(w);
  context.observer.phase("analysing");
  Choosing choosing(folder, spec, new_choice(spec), prepared, context);
  context.observer.phase("choosing");
  if (!choosing.run()) throw Stopped{};
  return choosing.choice();
}

}  // namespace lacuna
