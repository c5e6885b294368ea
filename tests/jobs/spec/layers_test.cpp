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
  std::vector<ImageLayer> common(common_layers.begin(), common_layers.end());
  common.push_back(ImageLayer::lengths);
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

TEST(Layers, OfLightAreRefusedWithTheReasonWhereAMethodCannotTellThemApart) {
  const auto refused = [](const std::string& integrator, const std::string& layer) {
    return layer_problems("\"integrator\": " + integrator + ", \"layers\": [" + layer + "]");
  };
  const std::string paths = R"({"light": "E.*L", "name": "all"})";
  for (const char* all : {"\"path\"", "\"light\"", "\"bdpt\"", "\"vcm\"", "\"sppm\"",
                          "\"photon_map\"", "\"metropolis\""}) {
    EXPECT_TRUE(refused(all, "\"lengths\", " + paths).empty()) << all;
  }
  EXPECT_TRUE(refused("\"many_lights\"", "\"lengths\"").empty());
  const auto expect = [&](const std::string& integrator, const std::string& layer,
                          const std::string& reason) {
    expect_one(refused(integrator, layer), "/layers/0", {reason, "allowed there"});
  };
  expect("\"inspect\"", "\"lengths\"",
         "\"lengths\" in a job of integrator \"inspect\", which shows");
  expect("\"inspect\"", paths, "an expression in a job of integrator \"inspect\", which shows");
  expect("\"auto\"", "\"lengths\"", "chooses the method");
  expect("\"many_lights\"", paths, "64 virtual lights at a time");
  expect(R"({"type": "many_lights", "gather": {"type": "random", "filter_radius": 2}})",
         "\"lengths\"", "filter_radius");
  expect(
      R"({"type": "many_lights", "visibility": {"type": "probabilistic", "clamp_negative": true}})",
      "\"lengths\"", "clamp_negative");
  expect(R"({"type": "path", "reuse": 16})", paths, "reuse");
}

TEST(Layers, OfExpressionsSayWhatIsWrongWithThem) {
  const auto given = [](const std::string& layers) {
    return layer_problems("\"layers\": [" + layers + "]");
  };
  expect_one(given(R"("depth", {"light": "EDX", "name": "a"})"), "/layers/1/light",
             {"EDX", "character 3: found \"X\""});
  expect_one(given(R"({"light": "D", "name": "a"})"), "/layers/0/light", {"begin with E"});
  expect_one(given(R"({"light": "E.*D.{12}L", "name": "a"})"), "/layers/0/light", {"256 states"});
  expect_one(given(R"({"light": "EL", "name": "a.b"})"), "/layers/0/name", {"a.b", "letters"});
  expect_one(given(R"({"light": "EL", "name": "a"}, {"light": "EDL", "name": "a"})"),
             "/layers/1/name", {"again"});
  expect_one(given(R"({"light": "EL"})"), "/layers/0/name", {"name"});
  std::string nine;
  for (int k = 0; k < 9; ++k) {
    nine += std::string(k > 0 ? ", " : "") + R"({"light": "EL", "name": "n)" + std::to_string(k) +
            "\"}";
  }
  expect_one(given(nine), "/layers/8", {"9", "8 at most"});
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
