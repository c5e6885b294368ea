#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "analysis/space_analysis/space_analysis.h"
#include "renderer/film/image.h"
#include "renderer/path/tile.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

struct VerdictMemory;

/// Thrown from an iteration when IterationContext::stop returned true. Its partial image is
/// discarded; running the iteration again gives the same result.
struct IterationStopped : Stopped {};

/// The inputs of one iteration.
struct IterationContext {
  const Scene& scene;
  const Camera& camera;
  const ThreadPool& pool;
  std::uint64_t seed;
  std::uint64_t iteration;  ///< < 2^32
  /// Called by several threads, between tiles, batches of paths and whatever else may take a
  /// second. When it returns true, IterationStopped is thrown.
  const std::function<bool()>& stop;
  /// One image for each layer that the integrator fills: black at first, of the picture's size.
  std::span<Image> layers = {};
  /// Of an integrator that renders parts: the tiles to render, which do not overlap. Empty: the
  /// whole picture.
  std::span<const Tile> parts = {};

  void check_stop() const {
    if (stop()) throw IterationStopped{};
  }
};

/// Asks whether to stop at one of 64 calls: asking reads a clock, which a short step must not pay.
class SparseStop {
 public:
  void check(const IterationContext& context) {
    if (++calls_ % 64 == 0) context.check_stop();
  }

 private:
  std::uint32_t calls_ = 0;
};

/// The inputs of prepare(), before the first iteration. `space` builds an artefact of the analysis
/// when it is first requested. Loops ask `pool` whether to stop (ThreadPool::check_stop()).
struct PrepareContext {
  const Scene& scene;
  const ThreadPool& pool;
  SpaceAnalysis& space;
  const Camera& camera;
  /// What the iterations may take: CPU seconds of each thread. None: not limited by time.
  std::optional<double> budget_seconds = std::nullopt;
  /// What is known of races on this picture; null: nothing, and nothing is to be kept.
  const VerdictMemory* verdicts = nullptr;
  /// A checkpoint will be loaded: what was prepared then is prepared again.
  bool resumes = false;
};

}  // namespace lacuna
