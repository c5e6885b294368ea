// The white furnace: under light from everywhere no surface sends back more than it gets.

#include <gtest/gtest.h>

#include "cases.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using cases::surfaces;
using cases::views;

/// Largest channel of the weights, and the weights' sum.
struct Furnace {
  std::array<statistics::Moments, 3> weight;

  Furnace(const Bsdf& bsdf, const V3f& wo, Transport transport, int n, std::uint64_t stream) {
    Rng random = cases::rng(stream);
    for (int i = 0; i < n; ++i) {
      const auto s = cases::sample(bsdf, wo, random, transport);
      for (int c = 0; c < 3; ++c)
        weight[static_cast<std::size_t>(c)].add(s ? double(s->weight[c]) : 0.0);
    }
  }
};

class Energy : public testing::TestWithParam<std::size_t> {
 protected:
  const cases::Surface surface_ = surfaces()[GetParam()];
};

/// Where ns = ng importance is scattered without the factor that refraction gives radiance. Where
/// it is not, the adjoint of shading normals may gain energy (Veach 1997, sec. 5.3.3), so that only
/// radiance is bounded there, and only if nothing refracts.
TEST_P(Energy, IsNotCreated) {
  const double level = statistics::sidak(1e-3, surfaces().size() * views().size() * 3);
  std::uint64_t stream = 1000 + GetParam() * 100;
  for (const cases::View& v : views()) {
    if (!surface_.bounded()) continue;
    const Bsdf bsdf = cases::bsdf(surface_.params, v.ng, v.ns);
    const bool alike = v.flat() && surface_.reciprocal();
    if (!alike && !surface_.opaque()) continue;
    const Furnace furnace(bsdf, v.wo, alike ? Transport::importance : Transport::radiance, 20000,
                          ++stream);
    for (const statistics::Moments& m : furnace.weight) {
      // Rounding of floats, and of the table that layers are made of.
      constexpr double rounding = 1e-3;
      EXPECT_GT(statistics::z_test_at_most(m, 1 + rounding), level)
          << v.name << ": mean weight " << m.mean() << " +- " << m.standard_error();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Energy, testing::Range(std::size_t{0}, surfaces().size()),
                         [](const auto& instance) { return surfaces()[instance.param].name; });

/// Every single weight is 1: these lose nothing and have no variance.
TEST(Energy, WhiteLambertAndMirrorReturnEverySampleWhole) {
  const cases::View v = views()[1];
  for (const SurfaceParams& p :
       {cases::lambert({1, 1, 1}), cases::layer(cases::lambert({0, 0, 0}), {1, 1, 1}, 1)}) {
    SurfaceParams params = p;
    if (p.f90 == 1) params.alpha = 0;
    const Bsdf bsdf(params, v.ng, v.ns);
    Rng random = cases::rng(7);
    for (const Transport transport : {Transport::radiance, Transport::importance}) {
      for (int i = 0; i < 2000; ++i) {
        const auto s = cases::sample(bsdf, v.wo, random, transport);
        ASSERT_TRUE(s);
        ASSERT_EQ(s->weight, Rgb(1, 1, 1));
      }
    }
  }
}

/// Reflected plus refracted is 1, on both sides and under total reflection; to rounding, and for
/// every sample.
TEST(Energy, SmoothGlassReturnsEverySampleWhole) {
  for (const float ior : {1.0F, 1.33F, 1.5F, 15.0F}) {
    const SurfaceParams params = cases::dielectric({1, 1, 1}, 0, ior, 1);
    for (const cases::View& v : views()) {
      if (!v.flat()) continue;
      const Bsdf bsdf(params, v.ng, v.ns);
      Rng random = cases::rng(8);
      for (int i = 0; i < 500; ++i) {
        const auto s = cases::sample(bsdf, v.wo, random, Transport::importance);
        ASSERT_TRUE(s) << v.name;
        ASSERT_TRUE(s->delta);
        ASSERT_NEAR(s->weight.x, 1, 1e-6) << v.name;
      }
    }
  }
}

/// Radiance shrinks by 1 / ior^2 on its way out to the eye, and grows by as much on its way in.
TEST(Energy, RefractionScalesRadianceByTheSquaredIndices) {
  const cases::View v = views()[1];
  const Bsdf bsdf(cases::dielectric({1, 1, 1}, 0, 1.5F, 1), v.ng, v.ng);
  Rng random = cases::rng(9);
  for (const float side : {1.0F, -1.0F}) {
    const float expected = side > 0 ? 1 / (1.5F * 1.5F) : 1.5F * 1.5F;
    for (int i = 0; i < 200; ++i) {
      const auto s =
          cases::sample(bsdf, cases::direction(v.ng, side * 0.9F, 1), random, Transport::radiance);
      ASSERT_TRUE(s);
      ASSERT_NEAR(s->weight.x, s->transmitted ? expected : 1, 1e-5);
    }
  }
}

/// A white base under a smooth layer gives back all that the layer lets through, also at grazing
/// angles.
TEST(Energy, LayerOverWhiteLosesNothing) {
  const V3f ng = views()[0].ng;
  for (const float cos : {1.0F, 0.5F, 0.2F, 0.02F}) {
    const Bsdf bsdf(cases::dielectric({1, 1, 1}, 0, 1.5F, 0), ng, ng);
    const Furnace furnace(bsdf, cases::direction(ng, cos, 1), Transport::radiance, 50000, 10);
    EXPECT_NEAR(furnace.weight[0].mean(), 1, 1e-3 + 4 * furnace.weight[0].standard_error()) << cos;
  }
}

/// The layer's means against GGX itself: with F = 1 the facets reflect the one, with Schlick's
/// weight alone the other.
TEST(Energy, LayerKnowsTheMeanFresnelFactorOfRoughFacets) {
  const V3f ng = views()[0].ng;
  for (const float alpha : {0.01F, 0.2F, 0.55F, 1.0F}) {
    const auto facets = [&](float f0) {
      SurfaceParams p = cases::layer(cases::lambert({0, 0, 0}), {f0, f0, f0}, 1);
      p.alpha = alpha;
      return Bsdf(p, ng, ng);
    };
    const Layer layer(0, 1, alpha);
    for (const float cos : {0.9F, 0.4F, 0.1F, 0.02F}) {
      const V3f wo = cases::direction(ng, cos, 1);
      const Furnace weighted(facets(0), wo, Transport::radiance, 20000, 12);
      const Furnace all(facets(1), wo, Transport::radiance, 20000, 12);
      EXPECT_NEAR(layer.mean_weight(cos), weighted.weight[0].mean() / all.weight[0].mean(),
                  0.012 + 4 * weighted.weight[0].standard_error())
          << alpha << " " << cos;
    }
  }
}

/// What enters a layer evenly from all around comes out again: no energy is lost between its two
/// passages.
TEST(Energy, LayerScaleIsNormalised) {
  for (const float alpha : {0.0F, 0.01F, 0.2F, 0.55F, 1.0F}) {
    const Layer layer(0.04F, 1, alpha);
    constexpr int n = 10000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const float cos = (static_cast<float>(i) + 0.5F) / n;
      sum += 2.0 / n * cos * layer.scale(1, layer.let_through(layer.mean_weight(cos)));
    }
    EXPECT_NEAR(sum, 1, 1e-5) << alpha;
  }
}

/// Half a smooth mirror, half Lambert: the shares are those of the mix.
TEST(Energy, MetallicMixesByItsShare) {
  const cases::View v = views()[1];
  SurfaceParams params = cases::mixed(cases::lambert({1, 1, 1}), 0.25F);
  params.alpha = 0;
  const Bsdf bsdf(params, v.ng, v.ns);
  Rng random = cases::rng(11);
  statistics::Moments mirrored, diffused;
  for (int i = 0; i < 40000; ++i) {
    const auto s = cases::sample(bsdf, v.wo, random, Transport::radiance);
    ASSERT_TRUE(s);
    mirrored.add(s->delta ? double(s->weight.x) : 0);
    diffused.add(s->delta ? 0 : double(s->weight.x));
  }
  EXPECT_GT(statistics::z_test(mirrored, 0.25), 1e-4) << mirrored.mean();
  EXPECT_GT(statistics::z_test(diffused, 0.75), 1e-4) << diffused.mean();
}

}  // namespace
}  // namespace lacuna
