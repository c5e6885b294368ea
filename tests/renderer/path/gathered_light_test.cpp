#include "renderer/path/gathered_light.h"

#include <gtest/gtest.h>

#include "renderer/guides/lobe_set.h"
#include "renderer/integrators/path_tracer.h"
#include "tests/renderer/integrators/render.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using statistics::Moments;

/// Lobes aimed at the lamp of cornell.glb. Keeps the training samples of the last iteration.
class SampleKeeper final : public GuidingDistribution {
 public:
  SampleKeeper(double probability, std::vector<TrainingSample>& kept)
      : probability_(probability), kept_(kept) {}
  bool needs_space() const override { return false; }
  GuidingCell cell(const Surface&, const V3f&) const override { return {1, 0}; }
  std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng&) const override {
    return lobes_.sample(at.x(), strength, u);
  }
  Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
    return lobes_.pdf(at.x(), w, strength);
  }
  std::size_t cells() const override { return 1; }
  AutoNumber probability() const override { return {probability_}; }
  bool learns() const override { return true; }
  std::vector<std::uint32_t> update(const TrainingSamples& samples, const ThreadPool&) override {
    kept_.assign(samples.all().begin(), samples.all().end());
    return {};
  }

 private:
  static constexpr float strength = 8;
  LobeSet lobes_{std::array{Target{{0, 1.98F, 0}, 1}}};
  double probability_;
  std::vector<TrainingSample>& kept_;
};

/// Of a small picture of cornell.glb whose paths neither end by roulette nor are split.
std::vector<TrainingSample> samples_of(PathSettings settings, double probability,
                                       std::uint64_t iteration) {
  settings.roulette_depth = settings.max_depth;
  std::vector<TrainingSample> kept;
  test::Session session(test::load({"cornell"}), {.width = 32, .height = 24},
                        std::make_unique<PathTracer>(
                            settings, Guide(std::make_unique<SampleKeeper>(probability, kept))));
  session.iterate(iteration);
  return kept;
}
std::vector<TrainingSample> samples_with(int reuse) {
  PathSettings settings;
  settings.max_depth = 4;
  settings.reuse = reuse;
  return samples_of(settings, 0.2, 3);
}

void expect_alike(double a, double b, const std::string& what) {
  EXPECT_NEAR(a, b, 1e-3 * std::abs(a) + 1e-6) << what;
}

// A path of two surfaces and the background, split in two at the second.
TEST(GatheredLight, OfAVertexIsThatOfAllBehindIt) {
  const Lobes white{SurfaceParams{.f0 = Rgb(0, 0, 0), .f90 = 0}};
  const V3f up(0, 0, 1), slanted = V3f(3, 0, 4) / 5;
  EyeBatch batch(3);
  std::vector<Vertex> path(4);
  for (std::size_t k : {1, 2}) {
    path[k].kind = Vertex::Kind::surface;
    path[k].surface.ng = path[k].surface.ns = path[k].wp = up;
    path[k].bsdf.emplace(white, up, up);
  }
  path[1].surface.x = {0, 0, 0};
  path[2].surface.x = slanted * 10.0F;
  path[2].surface.ng = path[2].surface.ns = path[2].wp = -slanted;
  path[2].bsdf.emplace(white, -slanted, -slanted);
  path[2].throughput = Rgb(0.5F);
  path[2].p_fwd = to_area(Pdf<SolidAngle>(0.3F), path[1], slanted, path[2]);
  path[3].kind = Vertex::Kind::background;
  path[3].wp = slanted;
  path[3].throughput = Rgb(0.25F);
  path[3].p_fwd = Pdf<Area>(0.2F);
  batch.states.push_back({.rng = Rng(1, 0, 0), .ray = {}, .p = {}, .path = path});
  std::copy(path.begin(), path.end(), batch.vertices.begin());

  GatheredLight gathered(batch);
  gathered.clear();
  PathState& state = batch.states[0];
  for (const auto& [depth, light, split] :
       {std::tuple{1, 10.0F, 1.0F}, {2, 3.0F, 2.0F}, {3, 1.0F, 2.0F}}) {
    state.roulette.split = split;
    gathered.reach(0, depth);
    gathered.add(0, depth, Rgb(light));
  }
  std::vector<TrainingSample> samples;
  gathered.record(samples);
  ASSERT_EQ(samples.size(), 2U);
  const TrainingSample &second = samples[0], &first = samples[1];
  EXPECT_NEAR(second.reflected, 2, 1e-5);  // 2 x 1, for a throughput of 2 x 0.5
  EXPECT_NEAR(second.radiance, 4, 1e-5);   // of 2 x 0.25
  EXPECT_NEAR(second.pdf, 0.2, 1e-6);
  EXPECT_EQ(second.distance, HUGE_VALF);
  EXPECT_NEAR(first.reflected, 8, 1e-5);  // 2 x 1 + 2 x 3
  EXPECT_NEAR(first.radiance, 8, 1e-5);
  EXPECT_NEAR(first.pdf, 0.3, 1e-6);
  EXPECT_NEAR(first.distance, 10, 1e-5);
  EXPECT_NEAR(first.cosine, 0.8, 1e-6);
  EXPECT_NEAR(first.bsdf_pdf, 0.8 * double(inv_pi), 1e-6);
}

// What pixels share is learned as if each path had kept it: rounding apart.
TEST(GatheredLight, OfPathsThatShareLightIsThatOfTheirOwn) {
  const std::vector<TrainingSample> own = samples_with(1), shared = samples_with(16);
  ASSERT_EQ(own.size(), shared.size());
  std::size_t lit = 0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    expect_alike(double(own[k].radiance), double(shared[k].radiance), "radiance of sample");
    expect_alike(double(own[k].reflected), double(shared[k].reflected), "reflected by sample");
    if (own[k].radiance > 0) ++lit;
  }
  EXPECT_GT(lit, own.size() / 8) << "the test has no power";
}

// The light that the surfaces in sight reflect is the same whatever sampled the directions there.
// Paths hit emitters: weights against next event estimation would differ with the guide.
TEST(GatheredLight, ReflectedLightDoesNotDependOnTheGuide) {
  PathSettings settings;
  settings.max_depth = 2;
  settings.next_event_estimation = false;
  Moments guided, plain;
  for (std::uint64_t i = 0; i < 100; ++i) {
    Moments of_guided, of_plain;
    for (const TrainingSample& s : samples_of(settings, 0.5, i)) {
      of_guided.add(double(s.reflected));
      if (!(s.pdf > 0)) continue;
      ASSERT_GE(s.pdf, 0.4999F * s.bsdf_pdf);
      ASSERT_NEAR(s.w.length(), 1, 1e-5);
      ASSERT_EQ(s.cell.probability, 0.5F);
    }
    for (const TrainingSample& s : samples_of(settings, 0, 1000 + i)) {
      of_plain.add(double(s.reflected));
      if (!(s.pdf > 0)) continue;
      ASSERT_NEAR(s.pdf, s.bsdf_pdf, 1e-3F * s.bsdf_pdf);
    }
    guided.add(of_guided.mean());
    plain.add(of_plain.mean());
  }
  EXPECT_GT(statistics::z_test(guided, plain), 1e-4) << guided.mean() << " and " << plain.mean();
  EXPECT_GT(plain.mean(), 10 * plain.standard_error()) << "the test has no power";
}

// Of a large picture only a share of the paths gives samples, spread evenly over it.
TEST(GatheredLight, OfALargePictureIsAShare) {
  PathSettings settings;
  settings.max_depth = settings.roulette_depth = 4;
  std::vector<TrainingSample> kept;
  test::Session session(
      test::load({"cornell"}), {.width = 1024, .height = 1024, .threads = 2},
      std::make_unique<PathTracer>(settings, Guide(std::make_unique<SampleKeeper>(0.2, kept))));
  session.iterate(0);  // in passes, of which the last is half of it
  EXPECT_LE(double(kept.size()), 0.6 * Guide::most_samples);
  for (std::uint64_t i = 1; i < 3; ++i) {
    session.iterate(i);
    EXPECT_LE(double(kept.size()), 1.1 * Guide::most_samples);
    EXPECT_GE(double(kept.size()), 0.4 * Guide::most_samples);
  }
}

}  // namespace
}  // namespace lacuna
