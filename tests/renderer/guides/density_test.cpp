// Every guide draws directions with the density that it reports.

#include <gtest/gtest.h>

#include "tests/renderer/guides/density_check.h"
#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

constexpr int density_draws = 10000;  // of each guide at each vertex

using test::DensityCheck;
using test::GuidedScene;
using test::PathScene;

struct Case {
  std::string name;
  GuideSettings guide;
  bool through = false;  ///< the guide's `through` is a portal's of each scene
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

SkeletonGuideSettings skeleton(double strength, ImportanceAim aim) {
  SkeletonGuideSettings s;
  s.strength = {strength};
  s.aim = aim;
  return s;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& [name, guide] : test::guides()) all.push_back({name, guide});
  all.push_back({"half_spheres", skeleton(0, ImportanceAim::tightest)});
  all.push_back({"blunt", skeleton(1e-3, ImportanceAim::mean)});
  all.push_back({"narrow", skeleton(100, ImportanceAim::last)});
  // Half of all faces are replaced, also near ones alone and slanting ones alone.
  auto thresholds = test::in_small_pictures(FaceIrradianceGuideSettings{});
  thresholds.least_distance = 0.1;
  all.push_back({"far_faces", thresholds});
  thresholds.least_cosine = 0.5;
  all.push_back({"far_facing_faces", thresholds});
  all.push_back({"far_facing_faces_through_one_border", thresholds, true});
  FaceIrradianceGuideSettings own_paths;
  own_paths.probability = AutoNumber{0.5};
  own_paths.learn_from = FacePaths::face;
  all.push_back({"faces_by_their_own_paths", own_paths});
  all.push_back({"through_one_portal", test::in_small_pictures(PortalsGuideSettings{}), true});
  all.push_back(
      {"through_one_border", test::in_small_pictures(FaceIrradianceGuideSettings{}), true});
  return all;
}

/// The guide of a case in a scene; none: it needs a portal, and the scene has none.
std::optional<GuideSettings> guide_in(const PathScene& s, const Case& c) {
  if (!c.through) return c.guide;
  const auto point = test::portal_point([&] { return load(s); }, environment(s));
  if (!point) return {};
  GuideSettings guide = c.guide;
  std::visit(
      [&](auto& settings) {
        if constexpr (requires { settings.through; }) settings.through = point;
      },
      guide);
  return guide;
}

constexpr std::size_t points = 4;

GuidedVertex guided(const Vertex& v) { return {v.surface, *v.bsdf, v.wp, v.guiding_cell}; }

class Density : public testing::TestWithParam<Case> {};

TEST_P(Density, IsThatOfItsSamples) {
  const std::vector<PathScene> scenes{{"cornell"}, {"ajar"},        {"bends"},
                                      {"atrium"},  {"many_lights"}, {"open", true}};
  const double level = statistics::sidak(1e-3, scenes.size() * cases().size() * points * 2);
  std::size_t checked = 0;
  for (const PathScene& s : scenes) {
    const auto settings = guide_in(s, GetParam());
    if (!settings) continue;
    const GuidedScene scene([&] { return load(s); }, *settings, 3, environment(s));
    const GuidingDistribution& directions = scene.directions();
    for (const Vertex& v : scene.guided_vertices(points)) {
      SCOPED_TRACE(testing::Message() << s << " at " << v.surface.x);
      ++checked;
      Rng rng(11, checked, 0, Rng::Purpose::test);
      const auto draw = [&] { return directions.sample(guided(v), rng.next_fine_point(), rng); };
      const auto density = [&](const V3f& w) { return directions.pdf(guided(v), w).value; };
      // Cells are smallest where most is drawn.
      const std::optional<V3f> pole = draw();
      const DensityCheck c =
          test::density_check(draw, density, density_draws, rng, pole.value_or(V3f(0, 0, 1)));
      EXPECT_GT(c.p, level) << "integral " << c.integral << " +- " << c.integral_error << ", "
                            << c.failed << " of the draws gave none";
      const double off = c.integral + c.failed - 1;
      const double error = std::hypot(c.integral_error, std::sqrt(c.failed / density_draws));
      EXPECT_LE(std::abs(off), 5 * error + 1e-4) << c.integral << " + " << c.failed;
    }
  }
  EXPECT_GE(checked, scenes.size() * points / 2) << "sites are missing";
}

// The whole guide, mixed with the surface's own scattering.
TEST_P(Density, WithTheSurfaceIsThatOfItsSamples) {
  const std::vector<PathScene> scenes{{"coated"}, {"leaning"}, {"ajar"}};
  const double level = statistics::sidak(1e-3, scenes.size() * cases().size() * points * 2);
  std::uint64_t checked = 0;
  for (const PathScene& s : scenes) {
    const auto settings = guide_in(s, GetParam());
    if (!settings) continue;
    const GuidedScene scene([&] { return load(s); }, *settings, 3, environment(s));
    // As Guide's own directions: those of the scene.
    class Lent final : public GuidingDistribution {
     public:
      explicit Lent(const GuidingDistribution& d) : d_(d) {}
      bool needs_space() const override { return d_.needs_space(); }
      GuidingCell cell(const Surface& x, const V3f& w) const override { return d_.cell(x, w); }
      std::optional<V3f> sample(const GuidedVertex& at, Rng::FinePoint u, Rng& rng) const override {
        return d_.sample(at, u, rng);
      }
      Pdf<SolidAngle> pdf(const GuidedVertex& at, const V3f& w) const override {
        return d_.pdf(at, w);
      }
      std::size_t cells() const override { return d_.cells(); }
      AutoNumber probability() const override { return {0.5}; }

     private:
      const GuidingDistribution& d_;
    };
    const Guide guide(std::make_unique<Lent>(scene.directions()));
    for (Vertex v : scene.guided_vertices(points)) {
      SCOPED_TRACE(testing::Message() << s << " at " << v.surface.x);
      guide.on_hit(v);
      Rng rng(13, ++checked, 0, Rng::Purpose::test);
      std::size_t wrong = 0;
      const auto draw = [&]() -> std::optional<V3f> {
        const auto d = guide.sample(v, rng, Transport::radiance);
        if (!d || d->delta) return std::nullopt;
        const Pdf<SolidAngle> p = guide.pdf(v, v.wp, d->wi, Transport::radiance);
        const Rgb f = v.bsdf->eval(v.wp, d->wi, Transport::radiance);
        wrong += std::abs(d->pdf.value - p.value) > 1e-5F * p.value ? 1 : 0;
        wrong += max_abs_component(d->weight * p.value - f) > 1e-4F * max_component(f) ? 1 : 0;
        return d->wi;
      };
      // Draws below the surface give nothing, though the density has them.
      const auto density = [&](const V3f& w) {
        const bool scatters = !is_black(v.bsdf->eval(v.wp, w, Transport::radiance));
        return scatters ? guide.pdf(v, v.wp, w, Transport::radiance).value : 0.0F;
      };
      const DensityCheck c = test::density_check(draw, density, density_draws, rng, v.surface.ng);
      EXPECT_GT(c.p, level) << "integral " << c.integral << " +- " << c.integral_error << ", "
                            << c.failed << " of the draws gave none";
      EXPECT_LE(c.integral, 1 + 5 * c.integral_error + 1e-4);
      EXPECT_EQ(wrong, 0U);
    }
  }
  EXPECT_GT(checked, points);
}

INSTANTIATE_TEST_SUITE_P(All, Density, testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace lacuna
