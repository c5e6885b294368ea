#include "renderer/guides/gathered_light.h"

#include <gtest/gtest.h>

#include "renderer/guides/lobe_set.h"
#include "renderer/guides/mixed_guide.h"
#include "renderer/guides/tuning.h"
#include "renderer/integrators/path_tracer.h"
#include "tests/renderer/integrators/render.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using statistics::Moments;

/// Lobes aimed at the lamp of cornell.glb, so that a guided path is up to 4 times as likely as it
/// would be by the BSDF, or half as likely; or the BSDF alone. Keeps the noise of each iteration.
class NoiseKeeper final : public GuidingDistribution {
 public:
  NoiseKeeper(bool guided, Tuning::Noise& kept) : guided_(guided), kept_(kept) {}
  bool needs_space() const override { return false; }
  GuidingCell cell(const Surface&, const V3f&) const override {
    return guided_ ? GuidingCell{0.5F, 0} : GuidingCell{};
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override {
    return lobes_.sample(at.x(), strength, u);
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return lobes_.pdf(at.x(), w, strength);
  }
  bool learns() const override { return true; }
  struct Kept : Accumulator {
    Tuning::Noise noise;
  };
  std::unique_ptr<Accumulator> accumulator() const override { return std::make_unique<Kept>(); }
  void record_noise(double variance, double by_bsdf, Accumulator& accumulator) const override {
    static_cast<Kept&>(accumulator).noise.add(variance, by_bsdf);
  }
  void update(std::span<const std::unique_ptr<Accumulator>> accumulators, const ThreadPool&,
              double) override {
    kept_ = {};
    for (const auto& a : accumulators) kept_.add(static_cast<const Kept&>(*a).noise);
  }

 private:
  static constexpr float strength = 8;
  LobeSet lobes_{std::array{Target{{0, 1.98F, 0}, 1}}};
  bool guided_;
  Tuning::Noise& kept_;
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
  Tuning::Noise kept;
  test::Session session(test::load({"cornell"}), {.width = 32, .height = 24},
                        std::make_unique<PathTracer<MixedGuide>>(
                            settings, MixedGuide(std::make_unique<NoiseKeeper>(guided, kept))));
  MeasuredNoise measured;
  for (int i = 0; i < iterations; ++i) {
    session.iterate(static_cast<std::uint64_t>(i));
    measured.variance.add(kept.mean());
    measured.by_bsdf.add(kept.by_bsdf / kept.pairs);
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
