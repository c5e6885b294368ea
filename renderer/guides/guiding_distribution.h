#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/bytes.h"
#include "renderer/path/contexts.h"
#include "renderer/path/guiding_sample.h"
#include "renderer/path/vertex.h"

namespace lacuna {

/// A vertex of which a path is to go on, or could have: all that a distribution may depend on.
struct GuidedVertex {
  const Surface& surface;
  const Bsdf& bsdf;
  const V3f& wo;            ///< unit, to where the path came from
  const GuidingCell& site;  ///< of the surface as seen from `wo`

  const V3f& x() const { return surface.x; }
};

/// A distribution of directions at every point of the scene's surfaces, of what a guide knows about
/// where light comes from. MixedGuide combines it with the BSDF. Iterations read it from several
/// threads; only end() and load() change what it draws from.
class GuidingDistribution {
 public:
  /// What the parts of an iteration learn apart and end() adds up in their order, so that the state
  /// is the same for any number of threads.
  struct Accumulator {
    virtual ~Accumulator() = default;
  };

  virtual ~GuidingDistribution() = default;

  /// What is called by the integrator's functions of these names; before prepare(): needs_space().
  virtual bool needs_space() const = 0;
  virtual void prepare(const PrepareContext&) {}
  virtual void save(ByteWriter&) const {}
  /// Throws std::runtime_error if what was saved is not of this scene.
  virtual void load(ByteReader&) {}
  virtual std::vector<std::pair<std::string, double>> statistics() const { return {}; }

  /// Where the distribution at surface `s`, as seen from the side of unit `w`, is found.
  virtual GuidingCell site(const Surface& s, const V3f& w) const = 0;
  /// Draws a unit direction; nothing where the draw fails. Only where the site's probability is
  /// above 0.
  virtual std::optional<V3f> sample(const GuidedVertex& at, Rng& rng) const = 0;
  /// Density with which sample() returns unit `w`; its integral over the sphere is 1 less the
  /// probability of failure. sample() never returns what has density 0, but for rounding.
  virtual Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const = 0;

  /// Whether learn() and end() want to be called in the coming iteration.
  virtual bool learns() const { return false; }
  virtual std::unique_ptr<Accumulator> accumulator() const { return nullptr; }
  virtual void accumulate(const GuidingSample&, Accumulator&) const {}
  virtual void update(std::span<const std::unique_ptr<Accumulator>>, const ThreadPool&) {}
};

}  // namespace lacuna
