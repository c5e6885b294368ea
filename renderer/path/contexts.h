#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "analysis/space_analysis/space_analysis.h"
#include "renderer/film/image.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Thrown from an iteration when IterationContext::stop returned true. Its partial image is
/// discarded; running the iteration again gives the same result.
struct IterationStopped {};

/// The inputs of one iteration.
struct IterationContext {
  const Scene& scene;
  const Camera& camera;
  const ThreadPool& pool;
  std::uint64_t seed;
  std::uint64_t iteration;  ///< < 2^32
  /// Called between tiles, by several threads. When it returns true, IterationStopped is thrown.
  const std::function<bool()>& stop;
  /// One image for each layer that the integrator fills: black at first, of the picture's size.
  std::span<Image> layers = {};
};

/// The inputs of prepare(), before the first iteration. `space` builds an artefact of the analysis
/// when it is first requested.
struct PrepareContext {
  const Scene& scene;
  const ThreadPool& pool;
  SpaceAnalysis& space;
};

}  // namespace lacuna
