// Pictures of samples that are spread evenly: they are right, their error is the one they claim,
// and it is smaller.

#include <gtest/gtest.h>

#include "renderer/film/metrics.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::Method;
using test::PathScene;
using test::Rendering;
using test::RenderSettings;

constexpr int across = 20, down = 12;
constexpr std::uint64_t first_seed = 100;

/// The pictures of several seeds, which are independent.
struct Seeds {
  Rendering each;  ///< block means and counters, by seed in place of iteration
  std::vector<Film> films;
};

Seeds render_seeds(const PathScene& scene, const IntegratorSettings& integrator, Sampler sampler,
                   int seeds, int iterations) {
  Seeds result;
  for (int k = 0; k < seeds; ++k) {
    Rendering r = test::render(load(scene), {.integrator = integrator,
                                             .width = across,
                                             .height = down,
                                             .iterations = iterations,
                                             .seed = first_seed + std::uint64_t(k),
                                             .sampler = sampler,
                                             .environment = environment(scene)});
    std::vector<double> mean(r.blocks[0].size(), 0.0);
    for (const auto& blocks : r.blocks) {
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += blocks[i] / iterations;
    }
    result.each.blocks.push_back(std::move(mean));
    result.each.counters += r.counters;
    result.films.push_back(std::move(r.film));
  }
  return result;
}

/// Methods that draw their paths in different ways.
std::vector<Method> methods(int edges, bool light) {
  PathSettings tree = test::path_tracing(edges);
  tree.emitters = EmitterChoice::tree;
  std::vector<Method> all{{"path", test::path_tracing(edges)},
                          {"tree", tree},
                          {"paired", test::joining(edges, PairedSettings{})},
                          {"skeleton", test::joining(edges, SkeletonConnectionsSettings{})}};
  if (light) all.push_back({"light", test::light_tracing(edges)});
  return all;
}

TEST(Sobol, AgreesWithIndependentNumbers) {
  struct Row {
    PathScene scene;
    int seeds;
    bool light;
    double useful;
  };
  for (const Row& row : {Row{{"cornell"}, 16, true, 0.03}, Row{{"glass"}, 16, false, 0.03},
                         Row{{"open", true}, 32, false, 0.06}, Row{{"spot"}, 16, true, 0.02},
                         Row{{"coated"}, 16, false, 0.02}}) {
    constexpr int edges = 4, iterations = 8;
    const Rendering expected =
        test::render(load(row.scene), {.integrator = test::path_tracing(edges),
                                       .width = across,
                                       .height = down,
                                       .iterations = 4 * row.seeds * iterations,
                                       .seed = 2,
                                       .environment = environment(row.scene)});
    for (const Method& method : methods(edges, row.light)) {
      SCOPED_TRACE(testing::Message() << row.scene << ", " << method);
      const Seeds found =
          render_seeds(row.scene, method.settings, Sampler::sobol, row.seeds, iterations);
      test::expect_same_picture(found.each, expected, row.useful);
    }
  }
}

/// The squared error of each seed's picture against the mean of all seeds, without bias.
std::vector<double> squared_errors(const Seeds& seeds) {
  const auto n = double(seeds.films.size());
  std::vector<double> mean(3 * across * down, 0.0), result;
  for (const Film& f : seeds.films) {
    const std::vector<double> one = f.mean();
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += one[i] / n;
  }
  for (const Film& f : seeds.films) {
    result.push_back(errors(f.mean(), mean)[ErrorMetric::mse] * n / (n - 1));
  }
  return result;
}

TEST(LongSobol, ClaimsTheErrorThatItHas) {
  constexpr int seeds = 90, iterations = 32;
  for (const PathScene& scene : {PathScene{"cornell"}, PathScene{"open", true}}) {
    for (const IntegratorSettings& method :
         {IntegratorSettings{test::path_tracing(4)},
          IntegratorSettings{test::joining(4, PairedSettings{})}}) {
      SCOPED_TRACE(testing::Message() << scene << ", " << method.index());
      const Seeds found = render_seeds(scene, method, Sampler::sobol, seeds, iterations);
      const std::vector<double> errors = squared_errors(found);
      statistics::Moments halves, layer, true_error;
      for (std::size_t k = 0; k < errors.size(); ++k) {
        halves.add(std::pow(*estimated_rmse(found.films[k]), 2) - errors[k]);
        double sum = 0;
        const std::vector<double> variance = found.films[k].variance_from_halves();
        for (const double v : variance) sum += v / double(variance.size());
        layer.add(sum - errors[k]);
        true_error.add(errors[k]);
      }
      const double least = 1e-4;
      EXPECT_GT(statistics::two_sided_p(halves.mean() / halves.standard_error()), least)
          << halves.mean() << " of " << true_error.mean();
      EXPECT_GT(statistics::two_sided_p(layer.mean() / layer.standard_error()), least);
      EXPECT_LT(halves.standard_error(), 0.2 * true_error.mean()) << "the test has no power";
    }
  }
}

// With as many samples, by how much the variance is smaller: direct light of a panel in a box.
TEST(Sobol, HasLessVariance) {
  constexpr int seeds = 16, iterations = 64;
  const auto variance = [&](Sampler sampler) {
    statistics::Moments m;
    for (const double e : squared_errors(
             render_seeds({"cornell"}, test::path_tracing(2), sampler, seeds, iterations))) {
      m.add(e);
    }
    return m;
  };
  const statistics::Moments spread = variance(Sampler::sobol),
                            plain = variance(Sampler::independent);
  EXPECT_LT(2 * spread.mean() + 4 * spread.standard_error(), plain.mean())
      << "not half of the variance";
}

// The same picture for any number of threads, and from any iteration on.
TEST(Sobol, IterationsStandAlone) {
  const RenderSettings one{.integrator = test::joining(4, PairedSettings{}),
                           .width = across,
                           .height = down,
                           .sampler = Sampler::sobol,
                           .threads = 1};
  RenderSettings two = one;
  two.threads = 2;
  test::Session a(load(PathScene{"cornell"}), one), b(load(PathScene{"cornell"}), two);
  for (const std::uint64_t i : {0, 1, 2}) a.iterate(i);
  EXPECT_EQ(a.iterate(9).pixels, b.iterate(9).pixels);
}

}  // namespace
}  // namespace lacuna
