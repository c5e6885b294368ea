#pragma once

#include <functional>
#include <memory>

#include "renderer/integrators/integrator.h"
#include "renderer/path/vertex.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

/// The density of a guide for integrator `inspect`: at one surface point, visible at a position of
/// the picture, for the directions to all other visible points (as Noel 2015, Fig. 70b and 86).
class GuideView {
 public:
  GuideView(const InspectSettings& settings, const PrepareContext& context);

  /// Call before colour(), for the iteration's picture.
  void start(const IterationContext& context, const Image& image);
  /// Density per steradian of the guide's directions towards `s`, which the eye sees along `d`;
  /// black where `s` is occluded from the point.
  Rgb colour(const Scene& scene, const Surface& s, const V3f& d, Counters& counters) const;

 private:
  std::array<double, 2> from_;
  std::function<void(Vertex&)> on_hit_;
  std::function<float(const Vertex&, const V3f&)> density_;
  Vertex point_;  // without Bsdf: the eye ray hit nothing
};

}  // namespace lacuna
