#pragma once

#include "renderer/path/vertex.h"

namespace lacuna {

/// One vertex of a finished path and the light that arrived there: a training sample of a guide.
struct GuidingSample {
  const Vertex& v;
  V3f wi;               ///< unit; the direction in which the path left `v`, not by a delta lobe
  Pdf<SolidAngle> pdf;  ///< with which `wi` was sampled
  float distance;       ///< to the next vertex, scene units; infinite to the background
  float radiance;       ///< luminance from `wi`, as estimated by the rest of the path
  float pixel_contribution;  ///< luminance that the rest of the path added to the pixel
};

}  // namespace lacuna
