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

/// Lobes aimed at the lamp of cornell.glb, which with probability .5 make a guided path up to 4
/// times as likely as it would be by the BSDF, or half as likely; with 0 the BSDF alone. Keeps what
/// it was told in each iteration.
class NoiseKeeper final : public GuidingDistribution {
 public:
  struct Learned {
    Tuning::Noise noise;
    std::vector<float> light;  ///< of all samples: radiance and contribution to the pixel
  };
  NoiseKeeper(float probability, Learned& kept) : probability_(probability), kept_(kept) {}
  bool needs_space() const override { return false; }
  GuidingCell cell(const Surface&, const V3f&) const override {
    return probability_ > 0 ? GuidingCell{probability_, 0} : GuidingCell{};
  }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override {
    return lobes_.sample(at.x(), strength, u);
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return lobes_.pdf(at.x(), w, strength);
  }
  bool learns() const override { return true; }
  struct Kept : Accumulator {
    Learned learned;
    double bytes() const override { return 0; }
  };
  std::unique_ptr<Accumulator> accumulator() const override { return std::make_unique<Kept>(); }
  void record_noise(double variance, double by_bsdf, Accumulator& accumulator) const override {
    static_cast<Kept&>(accumulator).learned.noise.add(variance, by_bsdf);
  }
  void accumulate(const GuidingSample& s, Accumulator& accumulator) const override {
    std::vector<float>& light = static_cast<Kept&>(accumulator).learned.light;
    light.insert(light.end(), {s.radiance, s.pixel_contribution});
  }
  void update(std::span<const std::unique_ptr<Accumulator>> accumulators, const ThreadPool&,
              double) override {
    kept_ = {};
    for (const auto& a : accumulators) {
      const Learned& learned = static_cast<const Kept&>(*a).learned;
      kept_.noise.add(learned.noise);
      kept_.light.insert(kept_.light.end(), learned.light.begin(), learned.light.end());
    }
  }

 private:
  static constexpr float strength = 8;
  LobeSet lobes_{std::array{Target{{0, 1.98F, 0}, 1}}};
  float probability_;
  Learned& kept_;
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
  NoiseKeeper::Learned kept;
  test::Session session(
      test::load({"cornell"}), {.width = 32, .height = 24},
      std::make_unique<PathTracer<MixedGuide>>(
          settings, MixedGuide(std::make_unique<NoiseKeeper>(guided ? 0.5F : 0.0F, kept))));
  MeasuredNoise measured;
  for (int i = 0; i < iterations; ++i) {
    session.iterate(static_cast<std::uint64_t>(i));
    measured.variance.add(kept.noise.mean());
    measured.by_bsdf.add(kept.noise.by_bsdf / kept.noise.pairs);
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

/// Of one small picture of cornell.glb whose paths neither end by roulette nor are split: they are
/// the same however many pixels share light.
NoiseKeeper::Learned learned_with(int reuse) {
  PathSettings settings;
  settings.max_depth = settings.roulette_depth = 4;
  settings.reuse = reuse;
  NoiseKeeper::Learned kept;
  test::Session session(test::load({"cornell"}), {.width = 32, .height = 24},
                        std::make_unique<PathTracer<MixedGuide>>(
                            settings, MixedGuide(std::make_unique<NoiseKeeper>(0.2F, kept))));
  for (std::uint64_t i = 0; i < 4; ++i) session.iterate(i);
  return kept;
}

void expect_alike(double a, double b, const std::string& what) {
  EXPECT_NEAR(a, b, 1e-3 * std::abs(a) + 1e-6) << what;
}

// What pixels share is learned as if each path had kept it: rounding apart.
TEST(GatheredLight, OfPathsThatShareLightIsThatOfTheirOwn) {
  const NoiseKeeper::Learned own = learned_with(1), shared = learned_with(16);
  expect_alike(own.noise.mean(), shared.noise.mean(), "noise");
  expect_alike(own.noise.by_bsdf / own.noise.pairs, shared.noise.by_bsdf / shared.noise.pairs,
               "noise by the BSDF");
  ASSERT_EQ(own.light.size(), shared.light.size());
  std::size_t lit = 0;
  for (std::size_t k = 0; k < own.light.size(); ++k) {
    expect_alike(double(own.light[k]), double(shared.light[k]), "sample " + std::to_string(k));
    if (own.light[k] > 0) ++lit;
  }
  EXPECT_GT(lit, own.light.size() / 4) << "the test has no power";
}

}  // namespace
}  // namespace lacuna
