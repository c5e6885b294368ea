// Chains in path space: every kind of proposal alone keeps the distribution that chains start with,
// and the extremes of their number and length.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::expect_same_picture;
using test::PathScene;
using test::Rendering;
using test::RenderSettings;

MetropolisSettings chains(int max_depth, const PathSpaceSettings& mutation) {
  MetropolisSettings s{test::whole_paths(max_depth)};
  s.mutation = mutation;
  s.direct_samples = 0;
  s.chains = 20;
  s.mutations = 10;
  s.bootstrap = 2;
  return s;
}

struct Case {
  PathScene scene;
  int max_depth, iterations;
  PixelFilter filter = PixelFilter::box;
  double useful = 0.1;
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.scene; }
};

class KeepsItsDistribution : public testing::TestWithParam<Case> {
 protected:
  RenderSettings picture(const IntegratorSettings& integrator, int iterations) const {
    const Case& c = GetParam();
    return {.integrator = integrator,
            .width = 20,
            .height = 12,
            .iterations = iterations,
            .environment = environment(c.scene),
            .filter = c.filter};
  }
};

// Chains start as the light is distributed. A proposal that is accepted too often or too rarely
// leads them away from there.
TEST_P(KeepsItsDistribution, ByEachKindOfProposal) {
  const Case& c = GetParam();
  RenderSettings expected = picture(test::path_tracing(c.max_depth), 4 * c.iterations);
  expected.seed = 2;
  const Rendering reference = render(load(c.scene), expected);
  const std::vector<std::pair<const char*, PathSpaceSettings>> kinds{
      {"independent", {.large_steps = 1, .bidirectional = 0, .lens = 0}},
      {"bidirectional", {.large_steps = 0, .bidirectional = 1, .lens = 0}},
      {"lens", {.large_steps = 0, .bidirectional = 0, .lens = 1}},
      {"between", {.large_steps = 0, .bidirectional = 0, .lens = 0}},
      {"independent, shadow rays no likelier than acceptance",
       {.large_steps = 1, .bidirectional = 0, .lens = 0, .least_tested = 1}}};
  for (const auto& [name, mutation] : kinds) {
    SCOPED_TRACE(name);
    expect_same_picture(render(load(c.scene), picture(chains(c.max_depth, mutation), c.iterations)),
                        reference, c.useful);
  }
}

INSTANTIATE_TEST_SUITE_P(All, KeepsItsDistribution,
                         testing::Values(Case{{"cornell"}, 5, 60, PixelFilter::tent},
                                         Case{{"glass"}, 5, 60}, Case{{"coated"}, 4, 60},
                                         Case{{"spot"}, 4, 60}, Case{{"directional"}, 4, 60},
                                         Case{{"open", true}, 4, 100, PixelFilter::box, 0.2},
                                         Case{{"leaning"}, 5, 60, PixelFilter::box, 0.2}),
                         [](const auto& c) { return c.param.scene.name; });

// From the sun and the sky, too, light goes through glass: the ray from infinity moves aside.
TEST(Metropolis, KeepsCausticsOfTheSun) {
  for (const bool sky : {false, true}) {
    SCOPED_TRACE(testing::Message() << "sky " << sky);
    const PathScene scene{"sunlit_glass", sky};
    const auto picture = [&](const IntegratorSettings& integrator, int iterations) {
      return test::render(load(scene), {.integrator = integrator,
                                        .width = 20,
                                        .height = 12,
                                        .iterations = iterations,
                                        .seed = iterations < 400 ? 1U : 2U,
                                        .environment = environment(scene)});
    };
    const Rendering reference = picture(test::joining(6, PairedSettings{}), 400);
    for (const PathSpaceSettings& mutation :
         {PathSpaceSettings{.large_steps = 0, .bidirectional = 0, .lens = 0},
          // Most moves cannot be undone: the way to the next vertex is too short or too long then.
          PathSpaceSettings{
              .large_steps = 0, .bidirectional = 0, .lens = 0, .largest_angle = 1, .octaves = 0.25},
          PathSpaceSettings{}}) {
      MetropolisSettings often = chains(6, mutation);
      often.bootstrap = 40;  // rare starts at a caustic are found in most iterations
      expect_same_picture(picture(often, 100), reference, 0.1);
    }
  }
}

RenderSettings square_picture(const IntegratorSettings& integrator, int side, int iterations) {
  return {.integrator = integrator, .width = side, .height = side, .iterations = iterations};
}

// One chain for a picture, more chains than pixels, and a picture of one pixel.
TEST(LongMetropolis, AnyNumberOfChains) {
  const PathScene scene{"point"};
  for (const auto& [number, side, iterations] :
       {std::tuple{1, 8, 400}, std::tuple{100000, 8, 20}, std::tuple{20, 1, 1000}}) {
    SCOPED_TRACE(testing::Message() << number << " chains, " << side << " x " << side);
    RenderSettings expected = square_picture(test::path_tracing(4), side, 8000);
    expected.seed = 2;
    MetropolisSettings s = chains(4, {});
    s.chains = number;
    expect_same_picture(render(load(scene), square_picture(s, side, iterations)),
                        render(load(scene), expected), 0.15);
  }
}

// Chains that start in one room hardly ever come to the other: what starts there decides their
// shares of the picture.
TEST(Metropolis, RoomsHaveTheirShares) {
  const PathScene scene{"two_rooms"};
  RenderSettings expected = square_picture(test::path_tracing(5), 8, 1600);
  expected.seed = 2;
  const Rendering reference = render(load(scene), expected);
  for (const int number : {1, 3, 50}) {
    SCOPED_TRACE(testing::Message() << number << " chains");
    MetropolisSettings s = chains(5, {});
    s.chains = number;
    expect_same_picture(render(load(scene), square_picture(s, 8, 400)), reference, 0.1);
  }
}

// At the border of a lamp most of the variance of a path tracer lies.
TEST(Metropolis, SeesEmittersSharply) {
  const PathScene scene{"cornell"};
  const auto picture = [&](const IntegratorSettings& integrator, int iterations) {
    RenderSettings s = square_picture(integrator, 32, iterations);
    s.filter = PixelFilter::tent;
    return render(load(scene), s);
  };
  MetropolisSettings s = chains(1, {});
  s.mutations = 16;
  // Which takes one sample of the emission that a pixel sees.
  ManyLightsSettings one_sample = test::of_length(ManyLightsSettings{}, 1);
  one_sample.light_paths = 1;
  const Rendering seen = picture(s, 200), simple = picture(one_sample, 800);
  expect_same_picture(seen, simple, 0.01);
  const auto variance = [](const Rendering& r, int iterations) {
    double sum = 0;
    for (const double v : r.film.variance_of_mean()) sum += v * iterations;
    return sum;
  };
  EXPECT_LT(variance(seen, 200), variance(simple, 800) / 16);
}

// In a furnace all of the film is alike, and the picture is known.
TEST(Metropolis, FillsAFurnaceEvenly) {
  for (const int depth : {2, 3, 6, 20}) {
    SCOPED_TRACE(testing::Message() << "depth " << depth);
    const double expected = 2 - std::pow(2.0, 1 - depth);
    RenderSettings s = square_picture(chains(depth, {}), 12, 300);
    s.camera = "inside";
    s.filter = PixelFilter::tent;
    const Rendering r = test::render("furnace.glb", s);
    for (std::size_t i = 0; i < r.blocks[0].size(); ++i) {
      const statistics::Moments m = test::over_iterations(r, i);
      EXPECT_GT(statistics::t_test(m, expected), 1e-7)
          << "block " << i / 3 << ": " << m.mean() << " +- " << m.standard_error() << ", not "
          << expected;
      EXPECT_LT(m.standard_error(), 0.05 * expected) << "the test has no power";
    }
  }
}

// The error that a picture claims is the error that it has: over many pictures, the squared error
// against a much better one has the mean of the variances that they estimate.
TEST(LongMetropolis, ClaimsTheErrorThatItHas) {
  const PathScene scene{"cornell"};
  RenderSettings better = square_picture(test::path_tracing(4), 16, 20000);
  better.seed = 9999;
  const std::vector<double> truth = render(load(scene), better).film.mean();
  statistics::Moments excess;  // of the squared error over the variance, relative to its mean
  double claimed_sum = 0;
  std::vector<std::pair<double, double>> pictures;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    RenderSettings s = square_picture(chains(4, {}), 16, 8);
    s.seed = seed;
    const Rendering r = render(load(scene), s);
    const std::vector<double> mean = r.film.mean(), variance = r.film.variance_of_mean();
    double error = 0, claimed = 0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      error += (mean[i] - truth[i]) * (mean[i] - truth[i]);
      claimed += variance[i];
    }
    claimed_sum += claimed;
    pictures.emplace_back(error, claimed);
  }
  for (const auto& [error, claimed] : pictures) {
    excess.add((error - claimed) * static_cast<double>(pictures.size()) / claimed_sum);
  }
  EXPECT_GT(statistics::two_sided_p(excess.mean() / excess.standard_error()), 1e-4)
      << "true over claimed error: 1 + " << excess.mean() << " +- " << excess.standard_error();
  EXPECT_LT(excess.standard_error(), 0.15) << "the test has no power";
}

}  // namespace
}  // namespace lacuna
