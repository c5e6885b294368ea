#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "analysis/space_analysis/space_analysis.h"
#include "renderer/core/rng.h"
#include "renderer/film/image.h"
#include "renderer/path/light_layers.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"
#include "renderer/settings/sampler.h"

namespace lacuna {

class PathObserver;

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
  /// Returns whether to stop; IterationStopped is then thrown. Several threads call it, at least
  /// about once a second: between tiles, between batches of paths, and within longer steps.
  const std::function<bool()>& stop;
  /// One image for each layer that the integrator fills: of the picture's size, black at first.
  std::span<Image> layers = {};
  Sampler sampler = Sampler::independent;
  /// The light by length and by expression: every contribution is added to it, too.
  LightSink light = {};
  PathObserver* observer = nullptr;  ///< of the paths of one pixel; null: none

  void check_stop() const {
    if (stop()) throw IterationStopped{};
  }

  /// The random numbers of path `path` < 2^56 of this iteration. With Sampler::sobol, the paths of
  /// this number in all even (or all odd) iterations are the points of one sequence.
  Rng path_numbers(std::uint64_t path, Rng::Purpose purpose) const {
    return path_numbers(path, 0, 1, purpose);
  }
  /// The same for path `k` < `n` of pixel `path`, which has `n` paths in each iteration, a power of
  /// two: with Sampler::sobol, all of them are points of the pixel's sequence.
  Rng path_numbers(std::uint64_t path, std::uint64_t k, std::uint64_t n,
                   Rng::Purpose purpose) const {
    if (sampler == Sampler::independent) return Rng(seed, iteration, path * n + k, purpose);
    return Rng::of_sequence(seed, path, half(), sample() * n + k, purpose);
  }
  /// The same for path `path` < `paths`, which contributes to the whole picture: with
  /// Sampler::sobol, all of these paths are points of one sequence.
  Rng shared_path_numbers(std::uint64_t path, std::uint64_t paths, Rng::Purpose purpose) const {
    if (sampler == Sampler::independent) return Rng(seed, iteration, path, purpose);
    constexpr std::uint64_t shared = (std::uint64_t{1} << 56) - 1;  // no path has this number
    return Rng::of_sequence(seed, shared, half(), sample() * paths + path, purpose);
  }

 private:
  // The two halves of a film are independent, and each has a sequence without gaps.
  std::uint32_t half() const { return static_cast<std::uint32_t>(iteration % 2); }
  std::uint64_t sample() const { return iteration / 2; }
};

/// Calls IterationContext::check_stop() at every 64th call of check(): it reads a clock, which
/// takes too long for a short step.
class SparseStop {
 public:
  void check(const IterationContext& context) {
    if (++calls_ % 64 == 0) context.check_stop();
  }

 private:
  std::uint32_t calls_ = 0;
};

/// The inputs of prepare(), before the first iteration. `space` builds an artefact of the analysis
/// when it is first requested. Long loops call ThreadPool::check_stop().
struct PrepareContext {
  const Scene& scene;
  const ThreadPool& pool;
  SpaceAnalysis& space;
  const Camera& camera;
};

}  // namespace lacuna
