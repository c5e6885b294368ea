// The guide of light paths draws directions with the density that it reports, from emitters and
// from surfaces, and leaves eye paths alone.

#include <gtest/gtest.h>

#include "renderer/guides/skeleton_directions.h"
#include "renderer/path/guide.h"
#include "tests/renderer/guides/density_check.h"
#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::DensityCheck;
using test::PathScene;

constexpr int draws = 20000;
constexpr std::size_t sites = 4;

struct Site {
  explicit Site(const PathScene& s)
      : scene([&] { return load(s); }, SkeletonGuideSettings{}, 0, environment(s)),
        guide(nullptr, std::make_unique<SkeletonDirections>(
                           SkeletonLightGuideSettings{.probability = 0.5, .strength = 8})) {
    guide.prepare(scene.context());
  }
  test::GuidedScene scene;
  Guide guide;
};

void expect_density(const DensityCheck& c) {
  const double level = statistics::sidak(1e-3, 3 * sites * 2);
  EXPECT_GT(c.p, level) << "integral " << c.integral << " +- " << c.integral_error << ", "
                        << c.failed << " of the draws gave none";
}

// A sample's throughput times its density is what the emitter sends there, over the density of the
// point; so the densities of all samples are those that they are drawn with.
TEST(LightGuide, FirstEdgesHaveTheirDensity) {
  std::size_t guided = 0;
  for (const char* name : {"cornell", "bends", "ajar"}) {
    const Site site(PathScene{name});
    const EmitterSet& lights = site.scene.scene().emitters();
    Rng rng(7, 0, 0, Rng::Purpose::test);
    for (std::size_t i = 0; i < sites; ++i) {
      const EmitterPoint e = lights.sample(lights.choose(rng));
      if (e.kind != EmitterPoint::Kind::area) continue;
      SCOPED_TRACE(testing::Message() << name << " at " << e.x);
      std::size_t wrong = 0, unlike = 0;
      const auto draw = [&]() -> std::optional<V3f> {
        const std::optional<LightLeSample> l = site.guide.sample_Le(lights, e, rng);
        if (!l) return std::nullopt;
        const V3f w = l->ray.d;
        const Rgb sent = e.towards(w) * (abs_dot(w, e.ng) / e.pdf.value);
        const Rgb carried = l->throughput * l->pdf.value;
        wrong += max_abs_component(carried - sent) > 1e-4F * max_component(sent) ? 1 : 0;
        unlike += std::abs(l->pdf.value - e.pdf_Le(w).value) > 0.01F * l->pdf.value ? 1 : 0;
        return w;
      };
      const auto density = [&](const V3f& w) {
        return is_black(e.towards(w)) ? 0.0F : site.guide.pdf_Le(e, w).value;
      };
      expect_density(test::density_check(draw, density, draws, rng, e.ng));
      EXPECT_EQ(wrong, 0U);
      guided += unlike > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(guided, sites);
}

TEST(LightGuide, ScattersWithItsDensity) {
  std::size_t guided = 0;
  for (const char* name : {"coated", "leaning", "ajar"}) {
    Site site(PathScene{name});
    Rng rng(8, 0, 0, Rng::Purpose::test);
    for (Vertex& v : site.scene.guided_vertices(sites)) {
      SCOPED_TRACE(testing::Message() << name << " at " << v.surface.x);
      site.guide.on_hit(v);
      const V3f along = v.side();
      guided += site.guide.pdf(v, v.wp, along, Transport::importance).value !=
                        Guide{}.pdf(v, v.wp, along, Transport::importance).value
                    ? 1
                    : 0;
      EXPECT_EQ(site.guide.pdf(v, v.wp, along, Transport::radiance).value,
                Guide{}.pdf(v, v.wp, along, Transport::radiance).value);
      std::size_t wrong = 0;
      const auto draw = [&]() -> std::optional<V3f> {
        const auto d = site.guide.sample(v, rng, Transport::importance);
        if (!d || d->delta) return std::nullopt;
        const float p = site.guide.pdf(v, v.wp, d->wi, Transport::importance).value;
        wrong += std::abs(d->pdf.value - p) > 1e-5F * p ? 1 : 0;
        return d->wi;
      };
      const auto density = [&](const V3f& w) {
        if (is_black(v.bsdf->eval(v.wp, w, Transport::importance))) return 0.0F;
        return site.guide.pdf(v, v.wp, w, Transport::importance).value;
      };
      expect_density(test::density_check(draw, density, draws, rng, v.surface.ng));
      EXPECT_EQ(wrong, 0U);
    }
  }
  EXPECT_GT(guided, sites);
}

}  // namespace
}  // namespace lacuna
