// Methods that merge: with a radius they have a bias, which must vanish with it. Tests are of means
// over the picture: few photons reach a block of it, so that its mean is far from normal.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/plates.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::Method;
using test::PathScene;
using test::Rendering;
using test::RenderSettings;
using test::Session;

/// The mean at radius 0 of a quantity whose mean is linear in the radius for small radii, as where
/// the disc reaches over an edge: 2 m(r / 2) - m(r).
struct Extrapolated {
  double mean, standard_error;
  Extrapolated(const Moments& at_half, const Moments& at_whole)
      : mean(2 * at_half.mean() - at_whole.mean()),
        standard_error(std::hypot(2 * at_half.standard_error(), at_whole.standard_error())) {}
  double same_p(const Moments& m) const {
    return statistics::two_sided_p(
        statistics::z_score(mean - m.mean(), std::hypot(standard_error, m.standard_error())));
  }
};

struct Place {
  PathScene scene;
  int iterations;
  double useful;  ///< largest standard error that is still a test, relative
  friend std::ostream& operator<<(std::ostream& out, const Place& p) { return out << p.scene; }
};
const std::vector<Place> places{
    {{"spot"}, 150, 0.03},
};
const std::vector<Place> more_places{
    {{"cornell"}, 250, 0.02},     {{"coated"}, 120, 0.04},     {{"mirror"}, 200, 0.05},
    {{"glass"}, 150, 0.04},       {{"leaning"}, 120, 0.08},    {{"point"}, 150, 0.04},
    {{"directional"}, 150, 0.04}, {{"open", true}, 250, 0.06}, {{"sides"}, 200, 0.03}};

class Merging : public testing::TestWithParam<Place> {};

TEST_P(Merging, GivesThePictureOfPathTracingAsTheRadiusVanishes) {
  const Place& place = GetParam();
  constexpr int max_depth = 4;
  const auto rendering = [&](const IntegratorSettings& s, int iterations, std::uint64_t seed) {
    return test::render(load(place.scene), {.integrator = s,
                                            .width = 36,
                                            .height = 24,
                                            .iterations = iterations,
                                            .seed = seed,
                                            .environment = environment(place.scene)});
  };
  const Rendering expected = rendering(test::path_tracing(max_depth), 4 * place.iterations, 2);
  const double level = statistics::sidak(1e-5, test::all_tests);
  for (const Method& method : test::merging(max_depth)) {
    SCOPED_TRACE(method);
    const Rendering narrow = rendering(
        test::fixed_radius(method.settings, 0.015, RadiusUnit::scene), place.iterations, 3);
    const Rendering wide = rendering(test::fixed_radius(method.settings, 0.03, RadiusUnit::scene),
                                     place.iterations, 4);
    const Extrapolated mean(mean_over_iterations(narrow), mean_over_iterations(wide));
    const Moments reference = mean_over_iterations(expected);
    EXPECT_GT(mean.same_p(reference), level)
        << mean.mean << " +- " << mean.standard_error << ", not " << reference.mean() << " +- "
        << reference.standard_error();
    EXPECT_LT(mean.standard_error, place.useful * reference.mean()) << "the test has no power";
    EXPECT_EQ(narrow.counters.rejected + wide.counters.rejected, 0U);
    EXPECT_EQ(narrow.counters.negative + wide.counters.negative, 0U);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Merging, testing::ValuesIn(places),
                         [](const auto& p) { return p.param.scene.name; });
INSTANTIATE_TEST_SUITE_P(Long, Merging, testing::ValuesIn(more_places),
                         [](const auto& p) { return p.param.scene.name; });

TEST(Vcm, WithoutMergingIsBidirectionalPathTracingBitByBit) {
  for (const GuideSettings& guide : {GuideSettings{}, GuideSettings{SdTreeGuideSettings{}}}) {
    VcmSettings vcm = test::of_length(VcmSettings{}, 5);
    vcm.merge = false;
    vcm.guide = guide;
    BdptSettings bdpt = test::joining(5, PairedSettings{});
    bdpt.guide = guide;
    for (const char* scene : {"ajar.glb", "glass.glb", "point.glb"}) {
      const Rendering a = test::render(scene, {.integrator = vcm, .iterations = 4});
      const Rendering b = test::render(scene, {.integrator = bdpt, .iterations = 4});
      EXPECT_EQ(a.film.mean(), b.film.mean()) << scene;
      EXPECT_EQ(a.counters.rays, b.counters.rays) << scene;
      EXPECT_EQ(a.counters.samples, b.counters.samples) << scene;
    }
  }
}

using Layers = std::map<std::string, Moments>;

Layers layers_of(const IntegratorSettings& settings, ImageLayer layer, int iterations,
                 std::uint64_t seed) {
  Session session(
      test::plates(),
      {.integrator = settings, .width = 30, .height = 25, .seed = seed, .layers = {layer}});
  Layers found;
  for (int i = 0; i < iterations; ++i) {
    session.iterate(static_cast<std::uint64_t>(i));
    for (std::size_t k = 0; k < session.layers().size(); ++k) {
      found[session.layer_names()[k]].add(test::sum_of(session.layers()[k]));
    }
  }
  return found;
}

// Merging alone, unweighted, at each vertex of a path gives all the light of its length.
TEST(MergingTechniques, EachAloneGivesAllTheLightOfItsLength) {
  constexpr int max_depth = 4;
  const IntegratorSettings vcm = test::of_length(VcmSettings{}, max_depth);
  const std::string layer = "strategies_unweighted.";
  const Layers narrow = layers_of(test::fixed_radius(vcm, 0.04, RadiusUnit::scene),
                                  ImageLayer::strategies_unweighted, 2500, 1);
  const Layers wide = layers_of(test::fixed_radius(vcm, 0.08, RadiusUnit::scene),
                                ImageLayer::strategies_unweighted, 1500, 2);
  int tested = 0;
  for (int k = 2; k <= max_depth; ++k) {
    const Moments* best = nullptr;  // of the joining strategies
    for (int s = 0; s <= k; ++s) {
      const Moments& m = narrow.at(fmt::format("{}s{}t{}", layer, s, k + 1 - s));
      if (best == nullptr || m.standard_error() < best->standard_error()) best = &m;
    }
    for (int s = 2; s <= k; ++s) {
      const std::string name = fmt::format("{}s{}t{}m", layer, s, k + 2 - s);
      const Extrapolated merged(narrow.at(name), wide.at(name));
      EXPECT_GT(merged.same_p(*best), 1e-6)
          << name << ": " << merged.mean << " +- " << merged.standard_error << ", not "
          << best->mean() << " +- " << best->standard_error();
      EXPECT_LT(merged.standard_error, 0.04 * best->mean()) << "the test has no power: " << name;
      ++tested;
    }
  }
  EXPECT_EQ(tested, 6);
}

TEST(MergingTechniques, WeightedAddUpToThePicture) {
  const VcmSettings paired = test::of_length(VcmSettings{}, 4);
  VcmSettings merges_only = paired, resampled = paired;
  merges_only.connect = false;
  resampled.connections = UniformSettings{};
  for (const VcmSettings& vcm : {paired, merges_only, resampled}) {
    const IntegratorSettings settings = test::fixed_radius(vcm, 0.05, RadiusUnit::scene);
    const RenderSettings layered{
        .integrator = settings, .width = 12, .height = 10, .layers = {ImageLayer::strategies}};
    RenderSettings plain = layered;
    plain.layers = {};
    Session with(test::plates(), layered), without(test::plates(), plain);
    double merged = 0;
    for (std::uint64_t i = 0; i < 4; ++i) {
      const Image image = with.iterate(i);
      EXPECT_EQ(image.pixels, without.iterate(i).pixels) << "layers change the picture";
      for (std::size_t p = 0; p < image.pixels.size(); ++p) {
        V3d all(0);
        for (const Image& l : with.layers()) all += V3d(l.pixels[p]);
        EXPECT_LT((all - V3d(image.pixels[p])).length(),
                  1e-5 * (V3d(image.pixels[p]).length() + 1e-6));
      }
      for (std::size_t k = 0; k < with.layers().size(); ++k) {
        if (with.layer_names()[k].ends_with("m")) merged += test::sum_of(with.layers()[k]);
      }
    }
    EXPECT_GT(merged, 0);
  }
}

}  // namespace
}  // namespace lacuna
