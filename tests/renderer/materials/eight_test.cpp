// A BSDF for eight directions at once, and a Lambertian one as a light, against its eval().

#include <gtest/gtest.h>

#include "cases.h"
#include "renderer/materials/bsdf_at_wo.h"

namespace lacuna {
namespace {

using cases::surfaces;
using cases::views;

class Eight : public testing::TestWithParam<std::size_t> {};

std::array<float, 8> array_of(Float8 v) {
  alignas(32) std::array<float, 8> a;
  v.store(a.data());
  return a;
}

TEST_P(Eight, AreTheBsdfOfEach) {
  const cases::Surface surface = surfaces()[GetParam()];
  Rng random = cases::rng(GetParam());
  int seen = 0;
  for (const auto& view : views()) {
    const Bsdf bsdf = cases::bsdf(surface.params, view.ng, view.ns);
    for (int n = 0; n < 300; ++n) {
      const V3f wo = cases::uniform_direction(random);
      if (bsdf.transmits()) return;
      const BsdfAtWo eight(bsdf, wo);
      alignas(32) std::array<float, 8> x, y, z;
      std::array<V3f, 8> w;
      for (std::size_t i = 0; i < 8; ++i) {
        w[i] = cases::uniform_direction(random);
        if (i < 4) {  // near the lobe
          if (const auto s = cases::sample(bsdf, wo, random, Transport::radiance)) w[i] = s->wi;
        }
        x[i] = w[i].x, y[i] = w[i].y, z[i] = w[i].z;
      }
      const Float8x3 f =
          eight.eval({Float8::load(x.data()), Float8::load(y.data()), Float8::load(z.data())});
      const auto r = array_of(f.x), b = array_of(f.z);
      for (std::size_t i = 0; i < 8; ++i) {
        const Rgb expected = bsdf.eval(wo, w[i], Transport::radiance);
        seen += is_black(expected) ? 0 : 1;
        const float tolerance = 1e-5F * max_component(expected) + 1e-12F;
        ASSERT_NEAR(r[i], expected.x, tolerance);
        ASSERT_NEAR(b[i], expected.z, tolerance);
      }
    }
  }
  if (cases::bsdf(surface.params, V3f(0, 0, 1), V3f(0, 0, 1)).connectible()) {
    EXPECT_GT(seen, 500);
  }
}

TEST_P(Eight, LitFromOneSide) {
  const cases::Surface surface = surfaces()[GetParam()];
  Rng random = cases::rng(GetParam());
  for (const auto& view : views()) {
    const Bsdf bsdf = cases::bsdf(surface.params, view.ng, view.ns);
    for (int n = 0; n < 1000; ++n) {
      const V3f from = cases::uniform_direction(random);
      const V3f w = cases::uniform_direction(random);
      const auto lit = bsdf.lambert_lobe(from);
      if (!lit) return;
      const float cos = dot(w, lit->side);
      const float t = dot(w, lit->ns) > 0 ? lit->shading_cosine_ratio : 1.0F;
      const Rgb f = cos > 0 ? lit->f * (cos * t) : Rgb(0, 0, 0);
      const Rgb expected = bsdf.eval(from, w, Transport::importance);
      ASSERT_NEAR(f.x, expected.x, 1e-5F * expected.x + 1e-7F);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, Eight, testing::Range(std::size_t{0}, surfaces().size()),
                         [](const auto& i) { return surfaces()[i.param].name; });

}  // namespace
}  // namespace lacuna
