// A delta lobe as Bsdf::delta() describes it, against what sampling draws.

#include <gtest/gtest.h>

#include "cases.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

const V3f slanted_normal = V3f(1, -2, 0.5F).normalized();

/// Frequency of the delta lobe from `from` to `to`, and its mean weight where it is drawn.
struct Drawn {
  int times = 0, of = 20000;
  Rgb weight{0, 0, 0};
};
Drawn draw(const Bsdf& bsdf, const V3f& from, const V3f& to, Transport transport) {
  Drawn d;
  Rng rng(5, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < d.of; ++i) {
    const auto [u_lobe, u] = rng.next_choice_and_point();
    const auto s = bsdf.sample(from, u_lobe, u, transport);
    if (!s || !s->delta || (s->wi - to).length2() > 1e-8F) continue;
    ++d.times;
    d.weight = s->weight;
  }
  return d;
}

/// p-value of so many draws at probability `p`.
double p_of(const Drawn& d, double p) {
  if (p > 1 - 1e-6) return d.times == d.of ? 1 : 0;
  return statistics::two_sided_p((d.times - p * d.of) / std::sqrt(d.of * p * (1 - p)));
}

TEST(Delta, ProbabilitiesAreThoseOfSampling) {
  int lobes = 0, refracted = 0;
  for (const cases::Surface& surface : cases::surfaces()) {
    for (const float tilt : {1.0F, 0.9F}) {
      const Bsdf bsdf =
          cases::bsdf(surface.params, slanted_normal, cases::direction(slanted_normal, tilt, 1));
      for (const float cos : {0.9F, 0.3F, -0.6F}) {
        for (const bool transmitted : {false, true}) {
          const V3f wo = cases::direction(slanted_normal, cos, 2);
          const auto lobe = bsdf.delta(wo, transmitted);
          if (!lobe) continue;
          SCOPED_TRACE(testing::Message() << surface.name << ", tilt " << tilt << ", cos " << cos
                                          << (transmitted ? ", transmitted" : ", reflected"));
          ++lobes;
          if (transmitted) ++refracted;
          const Drawn eye = draw(bsdf, wo, lobe->wi, Transport::radiance);
          EXPECT_GT(p_of(eye, lobe->p_radiance), 1e-6) << eye.times;
          if (eye.times > 0) {
            EXPECT_NEAR(eye.weight.x * lobe->p_radiance, lobe->value.x, 1e-4 * lobe->value.x);
          }
          const Drawn light = draw(bsdf, lobe->wi, wo, Transport::importance);
          const double p = lobe->p_importance / lobe->jacobian;
          EXPECT_GT(p_of(light, p), 1e-6) << light.times << ", not " << p * light.of;
          // Both walks find the same light: weights times densities, in one measure, differ by the
          // cosines with slanted_normal that the edges of a path bring.
          if (light.times > 0) {
            const double found = double(light.weight.x) * lobe->p_importance *
                                 double(abs_dot(lobe->wi, slanted_normal)) /
                                 double(abs_dot(wo, slanted_normal));
            EXPECT_NEAR(found, lobe->value.x, 1e-3 * lobe->value.x);
          }
        }
      }
    }
  }
  EXPECT_GT(lobes, 20);
  EXPECT_GT(refracted, 5);
}

TEST(Delta, NoneWhereNothingIsSmooth) {
  const Bsdf rough(cases::metal({1, 1, 1}, 0.3F), slanted_normal, slanted_normal);
  const Bsdf lambert(cases::lambert({1, 1, 1}), slanted_normal, slanted_normal);
  EXPECT_FALSE(rough.delta(slanted_normal, false));
  EXPECT_FALSE(lambert.delta(slanted_normal, false));
  EXPECT_FALSE(lambert.delta(slanted_normal, true));
}

}  // namespace
}  // namespace lacuna
