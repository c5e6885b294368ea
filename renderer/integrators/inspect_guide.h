#pragma once

#include "renderer/integrators/path_tracer.h"
#include "renderer/path/vertex.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

/// A guide for integrator `inspect`: its cells, their probabilities, or its density at one surface
/// point, visible at a position of the picture, for the directions to all other visible points (as
/// Noel 2015, Fig. 70b and 86).
class GuideView {
 public:
  GuideView(const InspectSettings& settings, const PrepareContext& context);

  /// What path tracing with this guide needs.
  static SceneNeeds needs(const GuideSettings& guide);

  /// Call before colour(), for the iteration's picture. The first call lets the guide learn. Throws
  /// IterationStopped.
  void start(const IterationContext& context, const Image& image);
  /// At `s`, which the eye sees along unit `d`.
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
  int learned_ = 0;  // iterations
  std::unique_ptr<PathTracer> tracer_;
  Vertex point_;  // without Bsdf: the eye ray hit nothing
};

}  // namespace lacuna
