// Guided rays find the same light: agreement with path tracing, also where the guide knows nothing,
// or leads into walls.

#include <gtest/gtest.h>

#include <set>

#include "tests/renderer/guides/guided_scene.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::expect_same_picture;
using test::Method;
using test::PathScene;
using test::Rendering;
using test::RenderSettings;
using test::SceneParts;

RenderSettings guided_picture(const IntegratorSettings& integrator, int iterations) {
  return {.integrator = integrator, .width = 20, .height = 12, .iterations = iterations};
}

struct GuidedAgreement {
  PathScene scene;
  int max_depth;
  int iterations;
  double useful;  ///< largest standard error of the mean, relative
  friend std::ostream& operator<<(std::ostream& out, const GuidedAgreement& a) {
    return out << a.scene;
  }
};

const std::vector<GuidedAgreement> guided_agreements{
    {{"cornell"}, 5, 200, 0.03},
    {{"spot"}, 3, 60, 0.02},
    {{"open", true}, 4, 150, 0.05},
    {{"ajar"}, 5, 200, 0.09},
};
const std::vector<GuidedAgreement> more_guided_agreements{
    {{"many_lights"}, 4, 300, 0.2}, {{"glass"}, 5, 150, 0.02},  {{"directional"}, 3, 150, 0.02},
    {{"atrium"}, 5, 120, 0.05},     {{"coated"}, 4, 120, 0.02}, {{"bends"}, 7, 150, 0.09},
    {{"leaning"}, 5, 200, 0.06},
};

class Guided : public testing::TestWithParam<GuidedAgreement> {};

TEST_P(Guided, AgreesWithPathTracing) {
  const GuidedAgreement& a = GetParam();
  RenderSettings plain = guided_picture(test::path_tracing(a.max_depth), 4 * a.iterations);
  plain.environment = environment(a.scene);
  plain.seed = 2;
  const Rendering expected = render(load(a.scene), plain);
  for (const Method& method : test::guided(a.max_depth)) {
    SCOPED_TRACE(method);
    RenderSettings s = guided_picture(method.settings, a.iterations);
    s.environment = environment(a.scene);
    // It learns from few of the vertices, which in small pictures leaves noise in its directions.
    const bool noisier = method.name == "path_learned_skeleton";
    expect_same_picture(render(load(a.scene), s), expected, noisier ? 1.3 * a.useful : a.useful);
  }
}

// Emitters that are hit weigh more, and nothing else finds the light.
TEST_P(Guided, AgreesWithoutNextEventEstimation) {
  const GuidedAgreement& a = GetParam();
  const std::set<std::string> large{"cornell", "glass", "coated", "leaning"};
  if (large.count(a.scene.name) == 0) return;
  PathSettings path = test::path_tracing(4);
  RenderSettings plain = guided_picture(path, 4 * a.iterations);
  plain.seed = 2;
  const Rendering expected = render(load(a.scene), plain);
  path.next_event_estimation = false;
  for (const auto& [name, guide] : test::guides()) {
    SCOPED_TRACE(name);
    path.guide = guide;
    expect_same_picture(render(load(a.scene), guided_picture(path, 3 * a.iterations)), expected,
                        0.06);
  }
}

// The thesis' SIS1 and FIS1: what does not come through the faces of a region's border is missed.
TEST(GuideOnly, MissesLightAndSaysSo) {
  PathSettings path = test::path_tracing(5);
  const PathScene scene{"ajar"};
  RenderSettings plain = guided_picture(path, 400);
  plain.seed = 2;
  const statistics::Moments all = test::mean_over_iterations(render(load(scene), plain));
  PortalsGuideSettings portals;
  portals.mixing = 0;
  portals.portal = PortalChoice::next;
  path.guide = portals;
  EXPECT_FALSE(biased(IntegratorSettings(path)));
  portals.guide_only = true;
  path.guide = portals;
  EXPECT_TRUE(biased(IntegratorSettings(path)));
  const statistics::Moments part =
      test::mean_over_iterations(render(load(scene), guided_picture(path, 400)));
  EXPECT_LT(part.mean(), all.mean());
  EXPECT_LT(statistics::t_test(part, all), 1e-4) << part.mean() << " of " << all.mean();
}

// SIS4 and FIS4, and the thresholds of 10.4.2, of which half of all faces fall below one.
TEST(NamedFaces, AgreeWithPathTracing) {
  const PathScene scene{"ajar"};
  const auto make = [&] { return load(scene); };
  RenderSettings plain = guided_picture(test::path_tracing(5), 800);
  plain.seed = 2;
  const Rendering expected = render(make(), plain);
  const auto point = test::portal_point(make, std::nullopt, plain.resolution);
  ASSERT_TRUE(point);
  const auto expect_agreement_of = [&](auto guide, const auto& change, const char* name) {
    SCOPED_TRACE(name);
    change(guide);
    PathSettings path = test::path_tracing(5);
    path.guide = guide;
    expect_same_picture(render(make(), guided_picture(path, 200)), expected, 0.09);
  };
  const auto half = [](auto guide) { return test::in_small_pictures(guide); };
  const auto through = [&](auto& guide) { guide.through = point; };
  expect_agreement_of(half(PortalsGuideSettings{}), through, "portal");
  expect_agreement_of(PortalsGuideSettings{}, through, "portal, learned probability");
  expect_agreement_of(half(FaceIrradianceGuideSettings{}), through, "border");
  const auto thresholds = [](auto& guide) {
    guide.least_distance = 0.1;
    guide.least_cosine = 0.5;
    guide.mixing = 0;
  };
  expect_agreement_of(half(FaceIrradianceGuideSettings{}), thresholds, "thresholds");
}

INSTANTIATE_TEST_SUITE_P(All, Guided, testing::ValuesIn(guided_agreements),
                         [](const auto& a) { return a.param.scene.name; });
INSTANTIATE_TEST_SUITE_P(Long, Guided, testing::ValuesIn(more_guided_agreements),
                         [](const auto& a) { return a.param.scene.name; });

/// Two rooms of 2 by 2 by 2, side by side along x, with a hole in the wall between them if `open`
/// (of a tenth of their height), the eye in the left one, and a lamp in each room that is lit.
SceneData rooms(bool open, bool left, bool right) {
  SceneParts p;
  const auto wall = p.material(test::diffuse(Rgb(0.7F, 0.6F, 0.5F)));
  p.box({-2.1F, -1, -1}, {2.1F, 1, 1}, false, wall);
  if (open) {
    p.box({-0.1F, -0.8F, -1}, {0.1F, 1, 1}, true, wall);
  } else {
    p.box({-0.1F, -1, -1}, {0.1F, 1, 1}, true, wall);
  }
  const auto shine = p.material(test::lamp(Rgb(30, 40, 50)));
  if (left) p.quad({-1.5F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, shine);
  if (right) p.quad({0.7F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, shine);
  p.eye({-1.9, 0.3, 0.8}, {0, -0.6, -0.4}, 1.2);
  return std::move(p.data);
}

void expect_agreement(const std::function<SceneData()>& make, const std::vector<int>& resolutions,
                      double useful) {
  RenderSettings plain = guided_picture(test::path_tracing(6), 1200);
  plain.seed = 2;
  const Rendering expected = render(make(), plain);
  for (const int resolution : resolutions) {
    for (const Method& method : test::guided(6)) {
      SCOPED_TRACE(testing::Message() << method << ", resolution " << resolution);
      RenderSettings s = guided_picture(method.settings, 200);
      s.resolution = resolution;
      expect_same_picture(render(make(), s), expected, useful);
    }
  }
}

TEST(LongGuidedExtremes, ALightThatTheCameraCannotReach) {
  // Another component of the empty space, kept for its light: nothing leads there.
  expect_agreement([] { return rooms(false, true, true); }, {24}, 0.05);
}

TEST(GuidedExtremes, OnlyALightThatTheCameraCannotReach) {
  for (const Method& method : test::guided(4)) {
    const Rendering r = render(rooms(false, false, true), guided_picture(method.settings, 4));
    for (const double v : r.film.mean()) EXPECT_EQ(v, 0) << method;
    EXPECT_EQ(r.counters.rejected, 0U);
  }
}

TEST(GuidedExtremes, NoLight) {
  for (const Method& method : test::guided(4)) {
    const Rendering r = render(rooms(true, false, false), guided_picture(method.settings, 3));
    for (const double v : r.film.mean()) EXPECT_EQ(v, 0) << method;
  }
}

TEST(LongGuidedExtremes, AGridSoCoarseThatTheDoorIsClosed) {
  // Of 4 voxels along the longest side none is empty; of 12 the hole is none.
  expect_agreement([] { return rooms(true, true, true); }, {1, 4, 12, 60}, 0.05);
}

TEST(GuidedExtremes, StrengthsAndProbabilities) {
  const auto make = [] { return rooms(true, true, true); };
  RenderSettings plain = guided_picture(test::path_tracing(5), 800);
  plain.seed = 2;
  const Rendering expected = render(make(), plain);
  for (const AutoNumber& strength : {AutoNumber{0}, {1e-3}, {1e4}, {}}) {
    for (const AutoNumber& probability : {AutoNumber{0}, {most_guided}, {}}) {
      SkeletonGuideSettings guide;
      guide.strength = strength;
      guide.probability = probability;
      PathSettings path = test::path_tracing(5);
      path.guide = guide;
      SCOPED_TRACE(testing::Message()
                   << strength.value.value_or(-1) << " " << probability.value.value_or(-1));
      const bool few = probability.value.value_or(0) > 0.9;  // follow the surfaces
      expect_same_picture(render(make(), guided_picture(path, few ? 800 : 200)), expected,
                          few ? 0.1 : 0.05);
    }
  }
}

TEST(GuidedExtremes, ProbabilityNoneIsPathTracingItself) {
  SkeletonGuideSettings guide;
  guide.probability = {0};
  PathSettings path = test::path_tracing(5);
  const auto make = [] { return rooms(true, true, true); };
  const Rendering expected = render(make(), guided_picture(path, 2));
  path.guide = guide;
  EXPECT_EQ(render(make(), guided_picture(path, 2)).film.mean(), expected.film.mean());
}

}  // namespace
}  // namespace lacuna
