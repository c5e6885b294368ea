#include <gtest/gtest.h>

#include "expect_problems.h"
#include "jobs/spec/job_json.h"

namespace lacuna {
namespace {

/// As the settings of an integrator that fills layers itself.
struct Filling {
  static constexpr std::array layers{ImageLayer::strategies, ImageLayer::distributions};
};
using Either = std::variant<PathSettings, Filling>;

TEST(Layers, SettingsListWhatTheirIntegratorFills) {
  EXPECT_TRUE(filled_layers(Either(PathSettings{})).empty());
  const auto own = filled_layers(Either(Filling{}));
  EXPECT_EQ(std::vector(own.begin(), own.end()),
            (std::vector{ImageLayer::strategies, ImageLayer::distributions}));
  const std::vector<ImageLayer> common(common_layers.begin(), common_layers.end());
  EXPECT_EQ(offered_layers(Either(PathSettings{})), common);
  std::vector<ImageLayer> all = common;
  all.insert(all.end(), own.begin(), own.end());
  EXPECT_EQ(offered_layers(Either(Filling{})), all);
}

std::vector<Problem> layer_problems(const std::string& more) {
  return problems_of([&] { parse_job(R"({"scene": "a", )" + more + "}"); });
}

TEST(Layers, OfAnotherIntegratorAreRefusedWhereTheyStand) {
  for (const char* name : {"path", "inspect"}) {
    const std::string integrator = "\"integrator\": \"" + std::string(name) + "\", ";
    for (const char* layer : {"strategies", "strategies_unweighted", "distributions"}) {
      const std::string given = R"("layers": ["variance", "depth", ")" + std::string(layer) + "\"]";
      expect_one(
          layer_problems(integrator + given), "/layers/2",
          {"found \"" + std::string(layer) + "\"", "integrator \"" + std::string(name) + "\"",
           "allowed there: \"variance\", \"halves\", \"albedo\", \"normal\", \"depth\""});
    }
    EXPECT_TRUE(layer_problems(integrator +
                               R"("layers": ["variance", "halves", "albedo", "normal", "depth"])")
                    .empty());
  }
}

TEST(Layers, EachIsOneProblemAndAWrongIntegratorIsTheOnlyOne) {
  const auto found = layer_problems(R"("layers": ["strategies", "depth", "distributions"])");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].pointer, "/layers/0");
  EXPECT_EQ(found[1].pointer, "/layers/2");
  expect_one(layer_problems(R"("integrator": "bdtp", "layers": ["strategies"])"), "/integrator",
             {"\"bdtp\""});
}

}  // namespace
}  // namespace lacuna
