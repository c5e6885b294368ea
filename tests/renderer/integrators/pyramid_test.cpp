// The strategies (s, t) one by one: each alone gives all the light of its path length, and their
// weighted parts are the picture.

#include <gtest/gtest.h>

#include <map>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/plates.h"
#include "tests/renderer/integrators/same_picture.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::Method;
using test::Session;

constexpr int max_depth = 4;

test::RenderSettings with_layers(const IntegratorSettings& integrator,
                                 std::vector<ImageLayer> layers) {
  return {.integrator = integrator, .width = 12, .height = 10, .layers = std::move(layers)};
}

class Pyramid : public testing::TestWithParam<Method> {};

TEST_P(Pyramid, EachStrategyAloneGivesAllTheLightOfItsLength) {
  Session session(test::plates(),
                  with_layers(GetParam().settings, {ImageLayer::strategies_unweighted}));
  std::map<std::string, Moments> found;
  for (std::uint64_t i = 0; i < 2500; ++i) {
    session.iterate(i);
    for (std::size_t k = 0; k < session.layers().size(); ++k) {
      found[session.layer_names()[k]].add(test::sum_of(session.layers()[k]));
    }
  }
  for (int k = 1; k <= max_depth; ++k) {
    const auto strategy = [&](int s) -> const Moments& {
      return found.at("strategies_unweighted.s" + std::to_string(s) + "t" +
                      std::to_string(k + 1 - s));
    };
    // The least noisy one is what the others are held against.
    int best = 0;
    for (int s = 1; s <= k; ++s) {
      if (strategy(s).standard_error() < strategy(best).standard_error()) best = s;
    }
    const double expected = strategy(best).mean();
    EXPECT_GT(expected, 0);
    for (int s = 0; s <= k; ++s) {
      if (s == best) continue;
      EXPECT_GT(test::same_p(strategy(s), strategy(best)), 1e-7)
          << "s " << s << ", t " << k + 1 - s << ": " << strategy(s).mean() << " +- "
          << strategy(s).standard_error() << ", not " << expected << " of s " << best;
      EXPECT_LT(strategy(s).standard_error(), 0.1 * expected)
          << "the test has no power: s " << s << ", t " << k + 1 - s;
    }
  }
}

TEST_P(Pyramid, WeightedStrategiesAddUpToThePicture) {
  Session plain(test::plates(), with_layers(GetParam().settings, {}));
  EXPECT_TRUE(plain.layer_names().empty());
  Session session(test::plates(), with_layers(GetParam().settings,
                                              {ImageLayer::distributions, ImageLayer::strategies}));
  for (std::uint64_t i = 0; i < 4; ++i) {
    const Image image = session.iterate(i);
    EXPECT_EQ(image.pixels, plain.iterate(i).pixels) << "layers change the picture";
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
      V3d all(0), drawn(0), connected(0);
      for (std::size_t k = 0; k < session.layers().size(); ++k) {
        const std::string& name = session.layer_names()[k];
        const V3d value(session.layers()[k].pixels[p]);
        if (name.starts_with("distributions.")) {
          drawn += value;
          continue;
        }
        all += value;
        if (!name.ends_with("t1") && !name.starts_with("strategies.s0")) connected += value;
      }
      const double slack = 1e-5 * (V3d(image.pixels[p]).length() + 1e-6);
      EXPECT_LT((all - V3d(image.pixels[p])).length(), slack) << "pixel " << p;
      // Distributions are what connections are drawn from.
      if (!GetParam().name.starts_with("paired")) {
        EXPECT_LT((drawn - connected).length(), slack);
      }
    }
  }
}

/// The light of each layer of distributions in iterations 0 and 1 of connections by the skeleton.
std::map<std::string, std::array<double, 2>> light_of_distributions(double acceptance) {
  Session session(
      test::plates(),
      with_layers(test::joining(max_depth, test::resampled<SkeletonConnectionsSettings>(
                                               64, [&](auto& s) { s.acceptance = acceptance; })),
                  {ImageLayer::distributions}));
  std::map<std::string, std::array<double, 2>> light;
  for (std::uint64_t i = 0; i < 2; ++i) {
    session.iterate(i);
    for (std::size_t k = 0; k < session.layers().size(); ++k) {
      light[session.layer_names()[k]][i] = test::sum_of(session.layers()[k]);
    }
  }
  return light;
}

// Uniform resampling where a node has no distributions is apart from the uniform one of a node.
TEST(Distributions, TellTheFallbackOfNodesThatWereNotAccepted) {
  auto light = light_of_distributions(1e6);
  EXPECT_EQ(light.size(), 4U);
  for (const char* own : {"visible", "unshadowed", "uniform"}) {
    EXPECT_EQ(light.at(std::string("distributions.") + own)[1], 0) << own;
  }
  EXPECT_GT(light.at("distributions.fallback")[1], 0);
  light = light_of_distributions(0);
  EXPECT_GT(light.at("distributions.fallback")[0], 0) << "before any node is known to be used";
  EXPECT_EQ(light.at("distributions.visible")[0], 0);
  EXPECT_GT(light.at("distributions.visible")[1], 0);
  EXPECT_LT(light.at("distributions.fallback")[1], 0.1 * light.at("distributions.visible")[1]);
}

INSTANTIATE_TEST_SUITE_P(All, Pyramid, testing::ValuesIn(test::connections(max_depth)),
                         [](const auto& m) { return m.param.name; });

}  // namespace
}  // namespace lacuna
