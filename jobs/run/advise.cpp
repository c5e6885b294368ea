#include "jobs/run/advise.h"

#include "jobs/run/prepare.h"
#include "renderer/integrators/integrator.h"

namespace lacuna {

RaceRecord advise(JobSpec spec, const RunContext& context) {
  if (!std::holds_alternative<AutoSettings>(spec.integrator)) {
    AutoSettings choosing;
    std::visit(
        [&]<class S>(const S& s) {
          if constexpr (std::is_base_of_v<PathLengths, S>) static_cast<PathLengths&>(choosing) = s;
        },
        spec.integrator);
    spec.integrator = choosing;
  }
  const Prepared prepared = prepare(spec, context);
  for (const std::string& w : prepared.warnings) context.observer.warning(w);
  context.observer.phase("analysing");
  analyse(prepared, spec.budget);
  context.observer.phase("racing");
  Image image(spec.resolution[0], spec.resolution[1]);
  prepared.integrator->iterate({.scene = *prepared.scene,
                                .camera = *prepared.camera,
                                .pool = *prepared.pool,
                                .seed = spec.seed,
                                .iteration = 0,
                                .stop = context.interrupted,
                                .sampler = spec.sampler},
                               image);
  return *prepared.integrator->race();
}

}  // namespace lacuna
