// Mirrors and smooth glass against the laws of optics.

#include <gtest/gtest.h>

#include "cases.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

const V3f slanted = V3f(1, -2, 0.5F).normalized();

/// Everything that the lobes return for one wo, each lobe seen through its whole interval of
/// u_lobe.
struct Outcome {
  V3f wi{0, 0, 0};
  double share = 0;  ///< mean weight
};
struct Split {
  Outcome mirrored, refracted;
};
Split split(const Bsdf& bsdf, const V3f& wo) {
  Split result;
  constexpr int n = 4096;
  for (int i = 0; i < n; ++i) {
    const float u = (static_cast<float>(i) + 0.5F) / n;
    const auto s = bsdf.sample(wo, u, {0.3F, 0.6F}, Transport::importance);
    if (!s || !s->delta) continue;
    Outcome& o = s->transmitted ? result.refracted : result.mirrored;
    o.wi = s->wi;
    o.share += double(s->weight.x) / n;
  }
  return result;
}

TEST(Specular, MirrorDirection) {
  const Bsdf bsdf(cases::metal({1, 1, 1}, 0), slanted, slanted);
  for (const float cos : {1.0F, 0.7F, 0.1F, 1e-3F, -0.4F}) {
    const V3f wo = cases::direction(slanted, cos, 1);
    const auto s = bsdf.sample(wo, 0.5F, {0.1F, 0.9F}, Transport::radiance);
    ASSERT_TRUE(s);
    EXPECT_TRUE(s->delta);
    EXPECT_FALSE(s->transmitted);
    EXPECT_LT((s->wi + wo - 2 * dot(wo, slanted) * slanted).length(), 3e-7);
  }
}

TEST(Specular, MirrorOfATiltedNormal) {
  const V3f ns = cases::direction(slanted, 0.95F, 1);
  const Bsdf bsdf(cases::metal({1, 1, 1}, 0), slanted, ns);
  const V3f wo = cases::direction(slanted, 0.6F, 2);
  const auto s = bsdf.sample(wo, 0.5F, {0.1F, 0.9F}, Transport::radiance);
  ASSERT_TRUE(s);
  EXPECT_LT((s->wi - reflect(wo, ns)).length(), 1e-6);
}

/// Where the mirror image by ns is behind the surface, light and eye meet in that by ng.
TEST(Specular, MirrorIntoTheSurfaceIsFlat) {
  const V3f leaning = cases::direction(slanted, 0.766F, 1 + pi);
  const V3f eye = cases::direction(slanted, 0.766F, 1);
  ASSERT_GT(dot(eye, leaning), 0);
  ASSERT_LT(dot(reflect(eye, leaning), slanted), 0);
  const Bsdf bsdf(cases::metal({1, 1, 1}, 0), slanted, leaning);
  const auto s = bsdf.sample(eye, 0.5F, {0.1F, 0.9F}, Transport::radiance);
  ASSERT_TRUE(s);
  EXPECT_LT((s->wi - reflect(eye, slanted)).length(), 1e-6);
  EXPECT_NEAR(s->weight.x, 1, 1e-6);
  Rng random = cases::rng(6);
  double back = 0;
  constexpr int n = 1000;
  for (int i = 0; i < n; ++i) {
    const auto light = cases::sample(bsdf, s->wi, random, Transport::importance);
    if (light && dot(light->wi, eye) > 0.999F) back += double(light->weight.x) / n;
  }
  EXPECT_NEAR(back, 1, 0.15);
}

/// The furnace of a smooth mirror of few facets: no fringe, and no light from nowhere.
TEST(Specular, MirrorsOfAnyShadingNormalReflectAllLight) {
  Rng random = cases::rng(7);
  for (int i = 0; i < 1000; ++i) {
    const V3f ns = cases::uniform_direction(random);
    const V3f eye = cases::uniform_direction(random);
    const Bsdf bsdf(cases::metal({1, 1, 1}, 0), slanted, ns);
    const auto s = cases::sample(bsdf, eye, random, Transport::radiance);
    ASSERT_TRUE(s) << "ns " << ns << ", eye " << eye;
    EXPECT_NEAR(s->weight.x, 1, 1e-6);
    EXPECT_GT(dot(s->wi, slanted) * dot(eye, slanted), 0);
  }
}

/// A flat triangle whose normals were interpolated, or point inwards, is still flat.
TEST(Specular, NormalsThatOnlyDifferByRoundingOrSignAreFlat) {
  const V3f wo = cases::direction(slanted, 0.6F, 1);
  for (const V3f& ns : {slanted, -slanted, (slanted + V3f(1e-7F, 0, 0)).normalized()}) {
    const Split s = split(Bsdf(cases::metal({1, 1, 1}, 0), slanted, ns), wo);
    EXPECT_NEAR(s.mirrored.share, 1, 1e-6);
    const Bsdf diffuse(cases::lambert({1, 1, 1}), slanted, ns);
    const auto d = diffuse.sample(wo, 0.7F, {0.2F, 0.3F}, Transport::importance);
    ASSERT_TRUE(d);
    EXPECT_EQ(d->weight, Rgb(1, 1, 1));
  }
}

/// sin / sin' = n' / n, in the plane of incidence, from both sides.
TEST(Specular, Snell) {
  for (const float ior : {1.0F, 1.05F, 1.33F, 1.5F, 2.4F, 15.0F}) {
    const Bsdf bsdf(cases::dielectric({1, 1, 1}, 0, ior, 1), slanted, slanted);
    for (const float cos : {0.999F, 0.8F, 0.3F, 0.01F, -0.999F, -0.9F}) {
      const V3f wo = cases::direction(slanted, cos, 1);
      const Outcome refracted = split(bsdf, wo).refracted;
      const float eta = cos > 0 ? ior : 1 / ior;
      const float sin_t = cross(wo, slanted).length() / eta;
      if (sin_t >= 1) {
        EXPECT_EQ(refracted.share, 0);
        continue;
      }
      ASSERT_GT(refracted.share, 0) << ior << " " << cos;
      EXPECT_NEAR(cross(refracted.wi, slanted).length(), sin_t, 1e-6 * std::max(1.0F, 1 / eta));
      EXPECT_LT(dot(refracted.wi, slanted) * cos, 0);
      EXPECT_NEAR(refracted.wi.length(), 1, 1e-6);
      EXPECT_LT(std::abs(dot(cross(wo, slanted), refracted.wi)), 1e-6);
    }
  }
}

/// Refract, then refract back along the found direction: the way of light can be reversed.
TEST(Specular, RefractionReverses) {
  const Bsdf bsdf(cases::dielectric({1, 1, 1}, 0, 1.5F, 1), slanted, slanted);
  for (const float cos : {0.9F, 0.5F, 0.1F}) {
    const V3f wo = cases::direction(slanted, cos, 1);
    const Outcome there = split(bsdf, wo).refracted;
    const Outcome back = split(bsdf, there.wi).refracted;
    EXPECT_LT((back.wi - wo).length(), 2e-6);
    EXPECT_NEAR(there.share, back.share, 1e-3);
  }
}

/// Born and Wolf, sec. 1.5: 4 % at normal incidence for 1.5; nothing of one polarisation at
/// Brewster's angle; everything beyond the critical angle.
TEST(Specular, Fresnel) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5F).reflectance, 0.04, 1e-7);
  EXPECT_NEAR(fresnel_dielectric(1, 1 / 1.5F).reflectance, 0.04, 1e-7);
  EXPECT_NEAR(fresnel_dielectric(1, 15).reflectance, 0.765625, 1e-6);
  EXPECT_EQ(normal_reflectance(1.5F), fresnel_dielectric(1, 1.5F).reflectance);
  const float brewster = std::cos(std::atan(1.5F));
  const double eta2 = 2.25, s = (eta2 - 1) / (eta2 + 1);
  EXPECT_NEAR(fresnel_dielectric(brewster, 1.5F).reflectance, s * s / 2, 1e-6);
  EXPECT_GT(fresnel_dielectric(1e-4F, 1.5F).reflectance, 0.999);
  // From both ends of one path the interface is the same.
  const Fresnel in = fresnel_dielectric(0.3F, 1.5F);
  EXPECT_NEAR(fresnel_dielectric(in.cos_t, 1 / 1.5F).reflectance, in.reflectance, 1e-6);
}

TEST(Specular, SmoothGlassSplitsByFresnel) {
  const Bsdf bsdf(cases::dielectric({1, 1, 1}, 0, 1.5F, 1), slanted, slanted);
  for (const float cos : {1.0F, 0.5F, 0.1F, -0.9F}) {
    const Split s = split(bsdf, cases::direction(slanted, cos, 1));
    const double f = fresnel_dielectric(std::abs(cos), cos > 0 ? 1.5F : 1 / 1.5F).reflectance;
    EXPECT_NEAR(s.mirrored.share, f, 1e-3);
    EXPECT_NEAR(s.refracted.share, 1 - f, 1e-3);
  }
}

TEST(Specular, TotalInternalReflection) {
  for (const float alpha : {0.0F, 0.001F}) {
    const Bsdf bsdf(cases::dielectric({1, 1, 1}, alpha, 1.5F, 1), slanted, slanted);
    const V3f wo = cases::direction(slanted, -0.5F, 1);  // the critical cosine is 0.745
    Rng random = cases::rng(1);
    for (int i = 0; i < 200; ++i) {
      const auto s = cases::sample(bsdf, wo, random, Transport::radiance);
      ASSERT_TRUE(s);
      EXPECT_FALSE(s->transmitted);
      EXPECT_NEAR(s->weight.x, 1, 0.01);
    }
  }
  // It stays whole where KHR_materials_specular takes all other reflection away.
  const Bsdf bare(cases::layer(cases::dielectric({1, 1, 1}, 0, 1.5F, 1), {0, 0, 0}, 0), slanted,
                  slanted);
  EXPECT_NEAR(split(bare, cases::direction(slanted, -0.5F, 1)).mirrored.share, 1, 1e-6);
  EXPECT_EQ(split(bare, cases::direction(slanted, 0.5F, 1)).mirrored.share, 0);
}

/// An index of 1 is no interface: nothing is bent and nothing reflected, rough or not, also at
/// grazing angles.
TEST(Specular, Ior1LetsEverythingPass) {
  for (const float alpha : {0.0F, 0.3F, 1.0F}) {
    const Bsdf bsdf(cases::dielectric({1, 1, 1}, alpha, 1, 1), slanted, slanted);
    for (const float cos : {1.0F, 0.3F, 1e-3F, -0.2F}) {
      const V3f wo = cases::direction(slanted, cos, 1);
      const Split s = split(bsdf, wo);
      EXPECT_EQ(s.mirrored.share, 0);
      EXPECT_NEAR(s.refracted.share, 1, 1e-6);
      EXPECT_LT((s.refracted.wi + wo).length(), 1e-6);
    }
  }
}

/// A rough interface whose index comes close to 1 neither jumps nor breaks down where it becomes
/// clear.
TEST(Specular, IndexCloseTo1) {
  const V3f wo = cases::direction(slanted, 0.6F, 1);
  const float limit = 1 + ggx_min_alpha / 0.5F;
  for (const float ior : {1.00001F, limit - 2e-5F, limit + 2e-5F, 1.001F}) {
    const Bsdf bsdf(cases::dielectric({1, 1, 1}, 0.5F, ior, 1), slanted, slanted);
    Rng random = cases::rng(2);
    statistics::Moments passed;
    for (int i = 0; i < 2000; ++i) {
      const auto s = cases::sample(bsdf, wo, random, Transport::importance);
      passed.add(s && s->transmitted ? double(s->weight.x) : 0.0);
      if (s && s->transmitted) {
        ASSERT_LT((s->wi + wo).length(), 40 * (ior - 1));
      }
    }
    // Masking alone takes a tenth from rough facets.
    EXPECT_GT(passed.mean(), 0.9);
    EXPECT_LT(passed.mean(), 1.001 + 4 * passed.standard_error());
  }
}

/// The mean facet hardly reflects, but those turned towards grazing light do, even totally: they
/// must be drawn often enough.
TEST(Specular, ClearInterfaceReflectsAtGrazingAngles) {
  const SurfaceParams p = cases::dielectric({1, 1, 1}, 0.5F, 1.00015F, 1);
  const Bsdf bsdf(p, slanted, slanted);
  ASSERT_TRUE(Interface(p).clear());
  const V3f wo = cases::direction(slanted, -0.035F, 1);  // the critical cosine is 0.0173
  const V3f mirrored = reflect(wo, slanted);
  Rng random = cases::rng(3);
  float largest = 0;
  for (int i = 0; i < 10000; ++i) {
    const V3f wi = (mirrored + 0.035F * cases::uniform_direction(random)).normalized();
    const float pdf = bsdf.pdf(wo, wi).value;
    if (pdf > 0) largest = std::max(largest, bsdf.eval(wo, wi, Transport::radiance).x / pdf);
  }
  EXPECT_GT(largest, 0);
  EXPECT_LT(largest, 2);
}

TEST(Specular, Connectible) {
  const auto connectible = [&](const SurfaceParams& p) {
    return Bsdf(p, slanted, slanted).connectible();
  };
  EXPECT_TRUE(connectible(cases::lambert({0.5F, 0.5F, 0.5F})));
  EXPECT_FALSE(connectible(cases::lambert({0, 0, 0})));
  EXPECT_FALSE(connectible(cases::metal({1, 1, 1}, 0)));
  EXPECT_FALSE(connectible(cases::metal({1, 1, 1}, 0.5F * ggx_min_alpha)));
  EXPECT_TRUE(connectible(cases::metal({1, 1, 1}, ggx_min_alpha)));
  EXPECT_FALSE(connectible(cases::dielectric({1, 1, 1}, 0, 1.5F, 1)));
  EXPECT_TRUE(connectible(cases::dielectric({1, 1, 1}, 0, 1.5F, 0)));
  EXPECT_FALSE(connectible(cases::dielectric({0, 0, 0}, 0, 1.5F, 0)));
}

}  // namespace
}  // namespace lacuna
