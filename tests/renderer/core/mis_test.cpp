#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "renderer/path/mis.h"

namespace lacuna {
namespace {

/// The definition: every strategy's density as a plain product, possible or not decided on its own
/// terms.
double by_products(const std::vector<VertexPdfs>& path, int s, const std::vector<double>& n) {
  const auto density = [&](std::size_t strategy) {
    if (strategy > 0 && !(path[strategy].connectible && path[strategy - 1].connectible)) return 0.0;
    double p = n[strategy];
    for (std::size_t i = 0; i < path.size(); ++i) {
      p *= i < strategy ? path[i].from_light : path[i].from_eye;
    }
    return p;
  };
  double sum = 0;
  for (std::size_t i = 0; i < n.size(); ++i) sum += density(i);
  return density(static_cast<std::size_t>(s)) / sum;
}

TEST(MisWeight, EqualsItsDefinition) {
  Rng rng(11, 0, 0, Rng::Purpose::test);
  for (int trial = 0; trial < 20000; ++trial) {
    const std::size_t length = 2 + rng.next_u32() % 7;
    std::vector<VertexPdfs> path(length);
    for (VertexPdfs& v : path) {
      v = {std::exp(8.0 * rng.next() - 4), std::exp(8.0 * rng.next() - 4), rng.next() < 0.8F};
    }
    std::vector<double> n(1 + rng.next_u32() % (length - 1));
    for (double& samples : n) samples = 1 + rng.next_u32() % 1000;
    double sum = 0;
    for (std::size_t s = 0; s < n.size(); ++s) {
      if (s > 0 && !(path[s].connectible && path[s - 1].connectible)) continue;
      const double w = mis_weight(path, static_cast<int>(s), {n});
      EXPECT_NEAR(w, by_products(path, static_cast<int>(s), n), 1e-12);
      sum += w;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(MisWeight, EmitterThatNoRayHits) {
  // A point light: the eye's density of it is 0, so next event estimation has all the weight.
  const std::vector<VertexPdfs> path{{1, 0, true}, {0, 0, true}};
  EXPECT_EQ(mis_weight(path, 1, {std::vector<double>{1, 1}}), 1);
}

TEST(MisWeight, EmitterThatIsNeverDrawn) {
  const std::vector<VertexPdfs> path{{0, 2, true}, {0, 0, true}};
  EXPECT_EQ(mis_weight(path, 0, {std::vector<double>{1, 1}}), 1);
}

}  // namespace
}  // namespace lacuna
