#pragma once

#include <functional>
#include <memory>

#include "renderer/integrators/integrator.h"
#include "renderer/path/vertex.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

/// What `inspect` shows of a guide: how densely it sends rays from one place, the surface seen at a
/// point of the picture, to all others that are seen (as Noel 2015, Fig. 70b and 86).
class GuideView {
 public:
  GuideView(const InspectSettings& settings, const PrepareContext& context);

  /// To be called before colour(), for the picture that is made.
  void start(const IterationContext& context, const Image& image);
  /// Density per steradian of the guide's rays towards `s`, seen along `d`; black where the place
  /// does not see it.
  Rgb colour(const Scene& scene, const Surface& s, const V3f& d, Counters& counters) const;

 private:
  std::array<double, 2> from_;
  std::function<void(Vertex&)> on_hit_;
  std::function<float(const Vertex&, const V3f&)> density_;
  Vertex place_;  // without Bsdf: nothing is seen there
};

}  // namespace lacuna
