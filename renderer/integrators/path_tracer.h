#pragma once

#include "renderer/integrators/guided_integrator.h"
#include "renderer/integrators/seen_emission.h"
#include "renderer/settings/path_settings.h"

namespace lacuna {

/// Path tracing (Noel 2015, 4.2): the walk hits an emitter (s = 0), and next event estimation at
/// every vertex (s = 1), combined by MIS (DirectLight).
class PathTracer final : public GuidedIntegrator {
 public:
  PathTracer(const PathSettings& settings, Guide guide);

  SceneNeeds needs() const override;
  void prepare(const PrepareContext& context) override;
  Counters iterate(const IterationContext& context, Image& image) override;

 private:
  class TilePass;

  Counters render_passes(const IterationContext& context, Image& image);

  PathSettings settings_;
  SeenEmission seen_;
};

}  // namespace lacuna
