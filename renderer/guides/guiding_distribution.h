#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/guides/learning_memory.h"
#include "renderer/path/contexts.h"
#include "renderer/path/guiding_sample.h"
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
/// light comes from. MixedGuide combines it with the BSDF. Several threads sample it during an
/// iteration; only update() and load() change it.
class GuidingDistribution {
 public:
  /// The samples of one part of an iteration. update() adds the accumulators in the order of the
  /// parts, so that the state is the same for any number of threads.
  struct Accumulator {
    virtual ~Accumulator() = default;
    /// The memory that its samples take, those of update() included.
    virtual double bytes() const = 0;
  };

  virtual ~GuidingDistribution() = default;

  /// Called by the integrator's functions of these names (see the concept Strategy).
  virtual bool needs_space() const = 0;
  virtual void prepare(const PrepareContext&) {}
  virtual void save(ByteWriter&) const {}
  /// Throws std::runtime_error if the state was saved for another scene.
  virtual void load(ByteReader&) {}
  virtual std::vector<std::pair<std::string, double>> statistics() const { return {}; }

  /// The cell of the distribution at surface `s`, on the side of unit `w`.
  virtual GuidingCell cell(const Surface& s, const V3f& w) const = 0;
  /// Prefetches what cell() of the same arguments reads first.
  virtual void prefetch(const Surface&, const V3f&) const {}
  /// Samples a unit direction by the uniform point `u`, and `rng` if that is not enough; nothing
  /// where the sample fails. Requires a cell whose probability is above 0. A direction that changes
  /// continuously with `u` nearly everywhere keeps points evenly spread (Sampler::sobol).
  virtual std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng& rng) const = 0;
  /// Density with which sample() returns unit `w`. Its integral over the sphere is 1 less the
  /// probability of failure. sample() returns a direction of density 0 only by rounding.
  virtual Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const = 0;

  /// All cells have probability 0, and will have: nothing of the guide is needed any more. Changes
  /// only in update() and load().
  virtual bool idle() const { return false; }

  /// Whether accumulate() and update() need to be called in the coming iteration.
  virtual bool learns() const { return false; }
  virtual std::unique_ptr<Accumulator> accumulator() const { return nullptr; }
  virtual void accumulate(const GuidingSample&, Accumulator&) const {}
  /// An estimate of the variance of one sample of a pixel, of squared luminance, and of what it
  /// would be if paths followed the BSDF.
  virtual void record_noise(double /*variance*/, double /*by_bsdf*/, Accumulator&) const {}
  /// `iterations`: as many as the accumulators hold, below 1 of a pilot.
  virtual void update(std::span<const std::unique_ptr<Accumulator>>, const ThreadPool&,
                      double /*iterations*/) {}

  /// The number of the pilot that is due before the coming iteration; none: no pilot is. A pilot
  /// renders a small part of the picture with random numbers of its own, only to be learned from.
  virtual std::optional<std::uint64_t> due_pilot() const { return std::nullopt; }
  /// What is sampled until update() is that pilot.
  virtual void begin_pilot() {}
};

}  // namespace lacuna
