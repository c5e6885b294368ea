#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/settings/auto_number.h"
#include "base/storage/bytes.h"
#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"
#include "renderer/path/training_samples.h"
#include "renderer/path/vertex.h"

namespace lacuna {

/// A vertex at which a direction is sampled or evaluated: all that a distribution may depend on.
struct GuidedVertex {
  const Surface& surface;
  const Bsdf& bsdf;
  const V3f& wo;            ///< unit, towards the previous vertex
  const GuidingCell& cell;  ///< of the surface as seen from `wo`

  const V3f& x() const { return surface.x; }
};

/// A distribution of directions at every point of the scene's surfaces, which approximates where
/// light comes from. Guide mixes it with the BSDF. Several threads sample it during an iteration;
/// only update() and load() change it.
class GuidingDistribution {
 public:
  virtual ~GuidingDistribution() = default;

  /// The functions of the concept Strategy.
  virtual bool needs_space() const = 0;
  virtual void prepare(const PrepareContext&) {}
  virtual void save(ByteWriter&) const {}
  /// Throws std::runtime_error if the state was saved for another scene.
  virtual void load(ByteReader&) {}
  virtual std::vector<std::pair<std::string, double>> statistics() const { return {}; }

  /// The cell of the distribution at surface `s`, on the side of unit `w`. Its probability is 1, or
  /// less if the distribution covers only a part of the light, or 0 if it has no directions.
  virtual GuidingCell cell(const Surface& s, const V3f& w) const = 0;
  /// Prefetches the first data that cell() reads with the same arguments.
  virtual void prefetch(const Surface&, const V3f&) const {}
  /// Samples a unit direction by the uniform point `u`, and by `rng` if more numbers are needed;
  /// none if the sample fails. Requires a cell whose probability is above 0. The direction should
  /// be a continuous function of `u` nearly everywhere: that keeps the stratification of
  /// Sampler::sobol.
  virtual std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng& rng) const = 0;
  /// Density with which sample() returns unit `w`. Its integral over the sphere is 1 less the
  /// probability of failure. sample() returns a direction of density 0 only by rounding.
  virtual Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const = 0;

  /// The number of cells: GuidingCell::index is less, or GuidingCell::none.
  virtual std::size_t cells() const = 0;
  /// How Guide finds the probability of sampling the distribution: learned for each cell, or one
  /// number for all.
  virtual AutoNumber probability() const = 0;
  /// Called before each iteration, whose paths have at most `edges` edges, for what is learned by
  /// paths other than those of the eye. An iteration that is repeated after IterationStopped, which
  /// it may throw, must find the same state.
  virtual Counters begin(const IterationContext&, int /*edges*/) { return {}; }
  /// Whether update() needs to be called after the coming iteration.
  virtual bool learns() const { return false; }
  /// Learns from the samples of a pass. Returns, for each cell that was added, the cell that it was
  /// split off from.
  virtual std::vector<std::uint32_t> update(const TrainingSamples&, const ThreadPool&) {
    return {};
  }
};

}  // namespace lacuna
