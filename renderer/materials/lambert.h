#pragma once

#include "renderer/core/density.h"
#include "renderer/core/frame.h"
#include "renderer/core/sampling.h"
#include "renderer/materials/disk.h"

namespace lacuna {

// Lambert's law: f = albedo / pi. Directions are sampled with density cos / pi, so f cos / pdf is
// exactly the albedo.

/// Samples a direction with density cos / pi around unit `n` (Malley's method). Its cosine is above
/// 3e-4.
inline V3f sample_cosine(const V3f& n, const V2f& u) {
  const V2f d = sample_disk(u);
  const Frame frame(n);
  return frame.to_world({d.x, d.y, std::sqrt(1 - d.x * d.x - d.y * d.y)});
}

}  // namespace lacuna
