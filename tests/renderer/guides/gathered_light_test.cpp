#include "renderer/guides/gathered_light.h"

#include <gtest/gtest.h>

#include "renderer/integrators/path_tracer.h"
#include "tests/renderer/integrators/render.h"
#include "tests/renderer/path/scenes.h"
#include "tests/renderer/path/sided_directions.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using statistics::Moments;

/// Means over an iteration's pairs of pixels.
struct PairNoise {
  double variance = 0, by_bsdf = 0, pairs = 0;
};

/// Sided directions, or the BSDF alone, whose pixels' noise is kept.
class NoiseKeeper final : public GuidingDistribution {
 public:
  NoiseKeeper(bool guided, PairNoise& kept) : guided_(guided), kept_(kept) {}
  bool needs_space() const override { return false; }
  GuidingCell cell(const Surface& s, const V3f& w) const override {
    return guided_ ? directions_.cell(s, w) : GuidingCell{};
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng& rng) const override {
    return directions_.sample(at, u, rng);
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return directions_.pdf(at, w);
  }
  bool learns() const override { return true; }
  struct Kept : Accumulator {
    PairNoise noise;
  };
  std::unique_ptr<Accumulator> accumulator() const override { return std::make_unique<Kept>(); }
  void record_noise(double variance, double by_bsdf, Accumulator& accumulator) const override {
    PairNoise& n = static_cast<Kept&>(accumulator).noise;
    n.variance += variance;
    n.by_bsdf += by_bsdf;
    ++n.pairs;
  }
  void update(std::span<const std::unique_ptr<Accumulator>> accumulators, const ThreadPool&,
              double) override {
    kept_ = {};
    for (const auto& a : accumulators) {
      const PairNoise& n = static_cast<const Kept&>(*a).noise;
      kept_.variance += n.variance;
      kept_.by_bsdf += n.by_bsdf;
      kept_.pairs += n.pairs;
    }
    kept_.variance /= kept_.pairs;
    kept_.by_bsdf /= kept_.pairs;
  }

 private:
  test::SidedDirections directions_;
  bool guided_;
  PairNoise& kept_;
};

struct MeasuredNoise {
  Moments variance, by_bsdf;
};

/// Of `iterations` small pictures of cornell.glb by paths that hit emitters, because weights
/// against next event estimation would be those of the guide.
MeasuredNoise measure(bool guided, int iterations) {
  PathSettings settings;
  settings.max_depth = 4;
  settings.next_event_estimation = false;
  PairNoise kept;
  test::Session session(test::load({"cornell"}), {.width = 32, .height = 24},
                        std::make_unique<PathTracer<MixedGuide>>(
                            settings, MixedGuide(std::make_unique<NoiseKeeper>(guided, kept))));
  MeasuredNoise measured;
  for (int i = 0; i < iterations; ++i) {
    session.iterate(static_cast<std::uint64_t>(i));
    measured.variance.add(kept.variance);
    measured.by_bsdf.add(kept.by_bsdf);
  }
  return measured;
}

TEST(GatheredLight, GuidedPathsTellTheNoiseOfTheBsdf) {
  const MeasuredNoise plain = measure(false, 600), guided = measure(true, 600);
  EXPECT_EQ(plain.variance.mean(), plain.by_bsdf.mean());
  EXPECT_GT(statistics::z_test(guided.by_bsdf, plain.variance), 1e-4)
      << guided.by_bsdf.mean() << " and " << plain.variance.mean();
  EXPECT_LT(statistics::z_test(guided.variance, plain.variance), 1e-4)
      << "the test has no power: " << guided.variance.mean();
}

}  // namespace
}  // namespace lacuna
