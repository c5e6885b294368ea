#pragma once

#include "renderer/path/vertex.h"

namespace lacuna {

/// The light that arrived at one vertex of a finished path, for guides that learn.
struct GuidingSample {
  const Vertex& v;      ///< left along `wi`, which was not drawn from a delta lobe
  V3f wi;               ///< unit
  Pdf<SolidAngle> pdf;  ///< with which it was drawn
  float radiance;       ///< luminance that arrived along `wi`, as the rest of the path estimates it
  float pixel_contribution;  ///< luminance of what the pixel got from there
};

}  // namespace lacuna
