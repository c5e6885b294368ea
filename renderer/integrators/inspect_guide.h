#pragma once

#include "renderer/integrators/path_tracer.h"
#include "renderer/path/vertex.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

/// Shows a guide, for the integrator `inspect`: its cells, their probabilities, or its density at
/// one visible surface point for the directions to all other visible points (as in Noel 2015, Fig.
/// 70b and 86).
class GuideView {
 public:
  GuideView(const InspectSettings& settings, const PrepareContext& context);

  /// Integrator::needs() of path tracing with this guide.
  static SceneNeeds needs(const GuideSettings& guide);

  /// Call at the start of an iteration, before colour(). The first call trains the guide. Throws
  /// IterationStopped.
  void start(const IterationContext& context, const Image& image);
  /// The colour of the surface `s`, which the camera sees along unit `d`.
  Rgb colour(const Scene& scene, const Surface& s, const V3f& d, std::uint64_t seed,
             Counters& counters) const;

 private:
  void learn(const IterationContext& context, const Image& image);
  /// `s` as a vertex that is seen along `d`.
  Vertex vertex(const Scene& scene, const Surface& s, const V3f& d) const;
  /// Density per steradian of the guide's directions towards `s`; black where `s` is occluded from
  /// the point.
  Rgb density(const Scene& scene, const Surface& s, const V3f& d, Counters& counters) const;

  InspectSettings settings_;
  int learned_ = 0;  // iterations of training so far
  std::unique_ptr<PathTracer> tracer_;
  Vertex point_;  // where the density is shown; without a Bsdf if the camera ray hit nothing
};

}  // namespace lacuna
