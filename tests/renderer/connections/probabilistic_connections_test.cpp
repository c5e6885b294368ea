// Distributions over the light vertices of all lengths at once.

#include "renderer/connections/probabilistic_connections.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/renderer/connections/lit_scene.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::Lit;

/// Weights of very different size for the vertices of some lengths, of which some have none.
std::vector<std::vector<double>> random_lengths(Rng& rng) {
  std::vector<std::vector<double>> all;
  for (int s = 1; s <= 5; ++s) {
    std::vector<double> w(rng.next_u32() % 12);
    const double scale = std::exp(10 * double(rng.next()) - 5);
    for (double& x : w) x = rng.next() < 0.3F ? 0 : scale * std::exp(4 * double(rng.next()));
    all.push_back(std::move(w));
  }
  return all;
}

TEST(JointDistribution, DrawsLengthsAndVerticesByTheirWeights) {
  Rng rng(91, 0, 0, Rng::Purpose::test);
  constexpr int trials = 8, draws = 60000;
  const double level = statistics::sidak(1e-6, trials * 5);
  for (int trial = 0; trial < trials; ++trial) {
    const auto weights = random_lengths(rng);
    JointDistribution joint;
    for (const auto& w : weights) joint.append(w);
    double total = 0;
    for (int longest = 1; longest <= 5; ++longest) {
      const auto& last = weights[static_cast<std::size_t>(longest) - 1];
      for (const double w : last) total += w;
      ASSERT_EQ(joint.empty(longest), total == 0);
      if (total == 0) continue;
      std::vector<double> observed, expected;
      std::vector<std::size_t> first;
      for (int s = 1; s <= longest; ++s) {
        first.push_back(observed.size());
        const auto& w = weights[static_cast<std::size_t>(s) - 1];
        for (std::uint32_t i = 0; i < w.size(); ++i) {
          EXPECT_NEAR(joint.pmf(longest, {s, i}), w[i] / total, 1e-6 * w[i] / total + 1e-12);
          observed.push_back(0);
          expected.push_back(draws * w[i] / total);
        }
      }
      for (int k = 0; k < draws; ++k) {
        const JointDistribution::Sample d = joint.sample(longest, rng);
        ASSERT_GE(d.s, 1);
        ASSERT_LE(d.s, longest);
        ++observed[first[static_cast<std::size_t>(d.s) - 1] + d.index];
      }
      const auto result = statistics::chi_square_test(observed, expected);
      EXPECT_GT(result.p, level) << result.message;
    }
  }
}

/// How often each vertex is sampled for an eye vertex, against the number of times it states.
void check_samples(const Lit& lit, const ProbabilisticConnections& connections, int draws,
                   const Vertex& v, int longest, Rng& rng) {
  struct Vertices {
    double stated = 0, sampled = 0;
  };
  std::map<std::pair<int, std::uint32_t>, Vertices> all;
  std::size_t n = 0;
  for (int s = 1; s <= longest; ++s) n += lit.lights.count(s);
  const int visits = static_cast<int>(400 * n) / draws;
  for (int k = 0; k < visits; ++k) {
    const auto lookup = connections.find(v, 1, rng);
    int uses = 0;
    connections.sample(
        lookup, LightRange{lit.lights, longest}, rng, [](int) { return 1.0F; },
        [&](int s, const VertexSample& d) {
          ++uses;
          ASSERT_LT(d.index, lit.lights.count(s));
          Vertices& one = all[{s, d.index}];
          EXPECT_TRUE(one.stated == 0 || one.stated == double(d.probability));
          one.stated = double(d.probability);
          ++one.sampled;
        });
    ASSERT_EQ(uses, draws);
  }
  EXPECT_EQ(all.size(), n) << "every vertex has a chance";
  double sum = 0;
  std::vector<double> observed, expected;
  for (const auto& [key, one] : all) {
    sum += one.stated;
    observed.push_back(one.sampled);
    expected.push_back(one.stated * visits);
  }
  EXPECT_NEAR(sum, draws, 1e-4 * draws);
  const auto result = statistics::chi_square_test(observed, expected);
  EXPECT_GT(result.p, 1e-8) << result.message;
}

TEST(ProbabilisticConnections, StateHowOftenTheySampleAVertex) {
  const ThreadPool pool(1);
  const std::function<bool()> never = [] { return false; };
  Rng rng(92, 0, 0, Rng::Purpose::test);
  const Lit lit(test::path_scenes().front());
  const IterationContext context{lit.scene, lit.camera, pool, 113, 0, never};
  EyeRecords eyes;
  Counters counters;
  eyes.place(context, lit.lights, 0.05, lit.lights.longest(), counters);
  ASSERT_GT(eyes.size(), 0U);
  for (const int draws : {1, 3}) {
    for (const int neighbours : {1, 4}) {
      for (const double uniform : {0.2, 1.0}) {
        ProbabilisticConnectionsSettings settings;
        settings.draws = draws;
        settings.neighbours = neighbours;
        settings.uniform = uniform;
        settings.record_density = 0.05;
        ProbabilisticConnections connections(settings);
        connections.begin(context, lit.lights, CellStatistics{}, counters);
        for (const int longest : {1, lit.lights.longest()}) {
          check_samples(lit, connections, draws, eyes[0].vertex, longest, rng);
        }
      }
    }
  }
}

}  // namespace
}  // namespace lacuna
