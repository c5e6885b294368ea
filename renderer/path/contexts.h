#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "analysis/space_analysis/space_analysis.h"
#include "renderer/film/image.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Thrown out of an iteration that was told to stop; what it had done is discarded, and the
/// iteration can be run again with the same result.
struct IterationStopped {};

/// What one iteration works with.
struct IterationContext {
  const Scene& scene;
  const Camera& camera;
  const ThreadPool& pool;
  std::uint64_t seed;
  std::uint64_t iteration;  ///< < 2^32
  /// Asked between tiles, from several threads: true ends the iteration by IterationStopped.
  const std::function<bool()>& stop;
  /// The images of the layers that the integrator fills, black; same size as the picture.
  std::span<Image> layers = {};
};

/// What a method may look at before its first iteration. `space` builds only what it is asked
/// for.
struct PrepareContext {
  const Scene& scene;
  const ThreadPool& pool;
  SpaceAnalysis& space;
};

}  // namespace lacuna
