// The strategies (s, t) one by one: each alone gives all the light of its path length, and their
// weighted parts are the picture.

#include <gtest/gtest.h>

#include <map>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::Method;
using test::Session;

constexpr int max_depth = 4;

/// Plates that do not touch, so that no connection is short: with all weights 1 the noise stays
/// finite. Every strategy can make every path.
SceneData plates() {
  test::SceneParts p;
  const auto plate = p.material(test::diffuse(Rgb(0.8F, 0.7F, 0.6F)));
  Material shining = test::diffuse(Rgb(0.5F));
  shining.emission = Rgb(2, 3, 4);
  p.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, plate);
  p.quad({-1, 0.5F, -1.6F}, {2, 0, 0}, {0, 1.2F, 0}, plate);
  p.quad({1.5F, 0.4F, 1}, {0, 0, -2}, {0, 1.2F, 0}, p.material(test::metal(Rgb(0.9F), 0.7F)));
  p.quad({-0.6F, 2.2F, -0.6F}, {1.2F, 0, 0}, {0, 0, 1.2F}, p.material(shining));
  p.eye({0.2, 1.1, 3.2}, {0, 0.9, -0.5}, 1.1);
  return std::move(p.data);
}

test::RenderSettings with_layers(const IntegratorSettings& integrator,
                                 std::vector<ImageLayer> layers) {
  return {.integrator = integrator, .width = 12, .height = 10, .layers = std::move(layers)};
}

double sum_of(const Image& image) {
  double sum = 0;
  for (const Rgb& p : image.pixels) sum += double(p.x) + double(p.y) + double(p.z);
  return sum;
}

class Pyramid : public testing::TestWithParam<Method> {};

TEST_P(Pyramid, EachStrategyAloneGivesAllTheLightOfItsLength) {
  Session session(plates(), with_layers(GetParam().settings, {ImageLayer::strategies_unweighted}));
  std::map<std::string, Moments> found;
  for (std::uint64_t i = 0; i < 2500; ++i) {
    session.iterate(i);
    for (std::size_t k = 0; k < session.layers().size(); ++k) {
      found[session.layer_names()[k]].add(sum_of(session.layers()[k]));
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
  Session plain(plates(), with_layers(GetParam().settings, {}));
  EXPECT_TRUE(plain.layer_names().empty());
  Session session(plates(), with_layers(GetParam().settings,
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
      if (GetParam().name != "paired") {
        EXPECT_LT((drawn - connected).length(), slack);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Pyramid, testing::ValuesIn(test::connections(max_depth)),
                         [](const auto& m) { return m.param.name; });

}  // namespace
}  // namespace lacuna
