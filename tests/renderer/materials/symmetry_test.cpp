// Reciprocity, and radiance against importance.

#include <gtest/gtest.h>

#include "cases.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using cases::surfaces;
using cases::views;

class Symmetry : public testing::TestWithParam<std::size_t> {
 protected:
  const cases::Surface surface_ = surfaces()[GetParam()];
};

/// f(a, b) / n_b^2 = f(b, a) / n_a^2 with n the index of refraction on the direction's side, where
/// ns = ng (Veach 1997, eq. 5.14).
TEST_P(Symmetry, Reciprocal) {
  if (!surface_.reciprocal()) GTEST_SKIP() << "as a bent normal it is its own adjoint only";
  const V3f ng = views()[0].ng;
  const Bsdf bsdf = cases::bsdf(surface_.params, ng, ng);
  Rng random = cases::rng(GetParam());
  const auto index = [&](const V3f& w) {
    return dot(w, ng) > 0 ? 1.0 : double(cases::index_behind(surface_.params));
  };
  const auto f = [&](const V3f& wo, const V3f& wi) {
    return double(bsdf.eval(wo, wi, Transport::radiance).y) / abs_dot(wi, ng);
  };
  int seen = 0;
  for (int i = 0; i < 5000; ++i) {
    const V3f a = cases::uniform_direction(random);
    // Half of the pairs close to a lobe, where sharp ones are not 0.
    V3f b = cases::uniform_direction(random);
    if (i % 2 == 0) {
      const auto s = cases::sample(bsdf, a, random, Transport::radiance);
      if (!s) continue;
      b = s->wi;
    }
    if (abs_dot(a, ng) < 1e-3F || abs_dot(b, ng) < 1e-3F) continue;
    // radiance's f(wo, wi) holds (n_o / n_i)^2.
    const double ab = f(a, b) * index(b) * index(b), ba = f(b, a) * index(a) * index(a);
    seen += ab > 0;
    // Half vectors are only known to the rounding of a direction over the width of the lobe, which
    // inside a dense medium is the narrower.
    const double ior = surface_.params.ior;
    const double bend = surface_.opaque() ? 1 : std::clamp(ior - 1, 1e-3, 1.0) / (ior * ior);
    const double rounding = 5e-4 + 1e-6 / std::max(surface_.params.alpha * bend, 1e-4);
    ASSERT_NEAR(ab, ba, rounding * std::max(ab, ba) + 1e-8);
  }
  // Without a boundary everything passes straight through.
  if (bsdf.connectible() && surface_.name != "glass_ior_1") {
    EXPECT_GT(seen, 1000);
  }
}

/// Value and density at once are those that are asked for one by one, to the bit.
TEST_P(Symmetry, EvaluatedAtOnce) {
  Rng random = cases::rng(GetParam());
  int lit = 0;
  for (const cases::View& view : views()) {
    const Bsdf bsdf = cases::bsdf(surface_.params, view.ng, view.ns);
    for (int i = 0; i < 400; ++i) {
      for (const Transport transport : {Transport::radiance, Transport::importance}) {
        V3f wi = cases::uniform_direction(random);
        if (const auto s = cases::sample(bsdf, view.wo, random, transport); s && i % 2 == 0) {
          wi = s->wi;
        }
        const Bsdf::Evaluated e = bsdf.evaluate(view.wo, wi, transport);
        ASSERT_EQ(e.value, bsdf.eval(view.wo, wi, transport)) << view.name;
        if (is_black(e.value)) continue;
        ASSERT_EQ(e.pdf.value, bsdf.pdf(view.wo, wi, transport).value) << view.name;
        ++lit;
      }
    }
  }
  const Bsdf bsdf = cases::bsdf(surface_.params, views()[0].ng, views()[0].ng);
  // Without a boundary everything passes straight through.
  if (bsdf.connectible() && surface_.name != "glass_ior_1") {
    EXPECT_GT(lit, 1000);
  }
}

/// The light that arrives at eyes, measured from both ends: paths that start at random eyes e and
/// sample the light's direction l, and paths that start at l and sample e, both estimate
///   integral of g(e) F(e, l) h(l) |e.ng| de dl   over the sphere.
/// A mode that draws where the other does not, or a wrong factor for shading normals or refraction,
/// tells them apart.
TEST_P(Symmetry, RadianceAndImportanceMeasureTheSameLight) {
  const double level = statistics::sidak(1e-3, surfaces().size() * 3);
  const V3f ng = views()[0].ng;
  const V3f towards_eye = V3f(0.3F, 0.2F, -0.9F).normalized();
  const V3f towards_light = V3f(0.9F, -0.4F, 0.1F).normalized();
  const auto g = [&](const V3f& e) { return 1.2 + dot(e, towards_eye); };
  const auto h = [&](const V3f& l) { return 1.2 + dot(l, towards_light); };
  for (const float tilt : {1.0F, 0.9F, 0.5F}) {
    SCOPED_TRACE(tilt);
    const V3f ns = tilt == 1 ? ng : cases::direction(ng, tilt, 0.4F);
    const Bsdf bsdf = cases::bsdf(surface_.params, ng, ns);
    Rng random = cases::rng(500 + GetParam());
    statistics::Moments from_eye, from_light;
    for (int i = 0; i < 40000; ++i) {
      const V3f start = cases::uniform_direction(random);
      const double cos = abs_dot(start, ng);
      const auto light = cases::sample(bsdf, start, random, Transport::radiance);
      from_eye.add(light ? g(start) * cos * double(light->weight.y) * h(light->wi) : 0.0);
      const auto eye = cases::sample(bsdf, start, random, Transport::importance);
      from_light.add(eye ? h(start) * cos * double(eye->weight.y) * g(eye->wi) : 0.0);
    }
    EXPECT_GT(statistics::z_test(from_eye, from_light), level)
        << "from the eye " << from_eye.mean() << " +- " << from_eye.standard_error()
        << ", from the light " << from_light.mean() << " +- " << from_light.standard_error();
  }
}

/// The same, pointwise.
TEST_P(Symmetry, EvalIsItsOwnAdjoint) {
  for (const cases::View& v : views()) {
    const Bsdf bsdf = cases::bsdf(surface_.params, v.ng, v.ns);
    Rng random = cases::rng(GetParam());
    for (int i = 0; i < 300; ++i) {
      const V3f w = cases::uniform_direction(random);
      const Rgb radiance = bsdf.eval(v.wo, w, Transport::radiance) * abs_dot(v.wo, v.ng);
      const Rgb importance = bsdf.eval(w, v.wo, Transport::importance) * abs_dot(w, v.ng);
      ASSERT_LE(max_abs_component(radiance - importance), 1e-3F * max_component(radiance) + 1e-8F);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Symmetry, testing::Range(std::size_t{0}, surfaces().size()),
                         [](const auto& instance) { return surfaces()[instance.param].name; });

/// Light never passes an opaque surface, whatever its shading normal says.
TEST(Symmetry, OpaqueSurfacesDoNotLeak) {
  for (const cases::Surface& surface : surfaces()) {
    if (!surface.opaque()) continue;
    for (const cases::View& v : views()) {
      const Bsdf bsdf = cases::bsdf(surface.params, v.ng, v.ns);
      Rng random = cases::rng(3);
      for (int i = 0; i < 200; ++i) {
        const V3f w = cases::uniform_direction(random);
        if (dot(w, v.ng) * dot(v.wo, v.ng) > 0) continue;
        ASSERT_TRUE(is_black(bsdf.eval(v.wo, w, Transport::radiance)));
        ASSERT_TRUE(is_black(bsdf.eval(v.wo, w, Transport::importance)));
        const auto s = cases::sample(bsdf, v.wo, random, Transport::radiance);
        if (s) {
          ASSERT_GT(dot(s->wi, v.ng) * dot(v.wo, v.ng), 0);
        }
      }
    }
  }
}

/// An eye behind ns sees the surface as if it were flat, not black.
TEST(Symmetry, EyesBehindTheShadingNormalSeeTheFlatSurface) {
  const V3f ng = views()[0].ng;
  const V3f ns = cases::direction(ng, 0.3F, 0);
  const V3f eye = cases::direction(ng, 0.2F, pi);
  ASSERT_LT(dot(eye, ns), 0);
  const SurfaceParams params = cases::lambert({0.5F, 0.5F, 0.5F});
  Rng random = cases::rng(4);
  const Bsdf tilted(params, ng, ns), flat(params, ng, ng);
  for (int i = 0; i < 100; ++i) {
    const V3f w = cases::uniform_direction(random);
    EXPECT_EQ(tilted.eval(eye, w, Transport::radiance), flat.eval(eye, w, Transport::radiance));
  }
}

/// The normals of some files point inwards: they say how the surface bends, not which side is out.
TEST(Symmetry, InvertedShadingNormalIsTurned) {
  const cases::View v = views()[6];
  const SurfaceParams params = cases::metal({1, 1, 1}, 0.3F);
  const Bsdf given(params, v.ng, v.ns), inverted(params, v.ng, -v.ns);
  Rng random = cases::rng(5);
  for (int i = 0; i < 100; ++i) {
    const V3f w = cases::uniform_direction(random);
    EXPECT_EQ(given.eval(v.wo, w, Transport::radiance),
              inverted.eval(v.wo, w, Transport::radiance));
  }
}

}  // namespace
}  // namespace lacuna
