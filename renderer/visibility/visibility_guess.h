#pragma once

#include <memory>
#include <string>

#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/visibility.h"

namespace lacuna {

/// A source of guesses of the visibility between shading points and virtual lights: any strategy
/// that answers without shadow rays, through its own interface (visibility.h). It may be wrong; how
/// often it is, rays measure (GuessReliability).
class GuessSource {
 public:
  /// Its guesses for the points that are gathered together. Used by one thread.
  class Tile {
   public:
    virtual ~Tile() = default;
    /// VisibilityEstimate::untested: the guessed visibility q in [0, 1] of each light of a block;
    /// VisibilityEstimate::tests: the lights of which the source knows nothing, whose q is 0.
    virtual void guess(std::size_t point, std::size_t block, const Terms& terms,
                       VisibilityEstimate& d) = 0;
  };

  virtual ~GuessSource() = default;
  virtual std::string_view name() const = 0;
  /// Time of a guess, in units of the light's shadow ray.
  virtual float cost() const = 0;
  virtual bool needs_space() const = 0;
  virtual void prepare(const PrepareContext& context) = 0;
  virtual std::uint64_t groups() const = 0;
  virtual LightGroup group(const VplGeometry& light) const = 0;
  virtual std::vector<BlockRange> passes(const VplSet& lights) const = 0;
  virtual Counters begin(const LightPass& pass) = 0;
  virtual std::unique_ptr<Tile> tile(std::span<const ShadingPoint> points,
                                     const IterationContext& context) const = 0;
  virtual std::vector<std::pair<std::string, double>> statistics() const = 0;
};

/// The guesses of a visibility strategy.
template <Visibility V>
class GuessOf final : public GuessSource {
 public:
  template <class Settings>
  GuessOf(std::string_view name, const Settings& settings) : name_(name), visibility_(settings) {}

  const V& visibility() const { return visibility_; }
  std::string_view name() const override { return name_; }
  float cost() const override { return V::guess_cost; }
  bool needs_space() const override { return visibility_.needs_space(); }
  void prepare(const PrepareContext& context) override { visibility_.prepare(context); }
  std::uint64_t groups() const override { return visibility_.groups(); }
  LightGroup group(const VplGeometry& light) const override { return visibility_.group(light); }
  std::vector<BlockRange> passes(const VplSet& lights) const override {
    return visibility_.passes(lights);
  }
  Counters begin(const LightPass& pass) override { return visibility_.begin(pass); }
  std::unique_ptr<Tile> tile(std::span<const ShadingPoint> points,
                             const IterationContext& context) const override {
    return std::make_unique<States>(visibility_, points, context);
  }
  std::vector<std::pair<std::string, double>> statistics() const override {
    return visibility_.statistics();
  }

 private:
  class States final : public Tile {
   public:
    States(const V& visibility, std::span<const ShadingPoint> points,
           const IterationContext& context)
        : visibility_(visibility) {
      states_.reserve(points.size());
      for (const ShadingPoint& p : points) states_.push_back(visibility_.at(p, context));
      visibility_.share(points, std::span(states_), context);
    }
    void guess(std::size_t point, std::size_t block, const Terms& terms,
               VisibilityEstimate& d) override {
      if (!visibility_.hides(states_[point], block)) {
        return visibility_.decide(states_[point], block, terms, d);
      }
      d.tests = 0;
      d.untested.v.fill(0);
    }

   private:
    const V& visibility_;
    std::vector<typename V::At> states_;
  };

  std::string_view name_;
  V visibility_;
};

/// The sources that `settings` name; cache points are those of `settings`.
std::vector<std::unique_ptr<GuessSource>> guess_sources(
    const ProbabilisticVisibilitySettings& settings);

}  // namespace lacuna
