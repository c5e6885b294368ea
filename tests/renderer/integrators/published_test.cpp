// The departures from the papers (renderer/settings/departures.h), undone: the same picture by
// other means, z-tested against path tracing.

#include <gtest/gtest.h>

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

RenderSettings published_picture(const IntegratorSettings& integrator, int iterations) {
  return {.integrator = integrator, .width = 20, .height = 12, .iterations = iterations};
}

/// Path tracing as published with `guide`, whose probability is 1/2.
Method guided_as_published(int max_depth, std::string name, GuideSettings guide) {
  std::visit(
      [](auto& s) {
        if constexpr (requires { s.roulette; }) s.roulette = GuidedRoulette::throughput;
        if constexpr (requires { s.probability; }) s.probability = AutoNumber{0.5};
        if constexpr (requires { s.mixing; }) s.mixing = 0;
      },
      guide);
  PathSettings path = test::path_tracing(max_depth);
  path.heuristic = Heuristic::balance;
  path.guide = guide;
  return {std::move(name), path};
}

std::vector<Method> as_published(int max_depth) {
  PortalsGuideSettings portals;
  portals.portal = PortalChoice::next;
  portals.paths = PortalPaths::light_region;
  FaceIrradianceGuideSettings faces;
  faces.learn_from = FacePaths::face;
  SkeletonGuideSettings skeleton;
  skeleton.aim = ImportanceAim::mean;
  PairedSettings paired;
  paired.direct = DirectPoint::light_path;
  BdptSettings guided = test::joining(max_depth, paired);
  guided.guide = faces;
  return {guided_as_published(max_depth, "bsdf", BsdfGuideSettings{}),
          guided_as_published(max_depth, "skeleton", skeleton),
          guided_as_published(max_depth, "portals", portals),
          guided_as_published(max_depth, "face_irradiance", faces),
          guided_as_published(max_depth, "sd_tree", SdTreeGuideSettings{}),
          {"paired", test::joining(max_depth, paired)},
          {"paired, face_irradiance", guided}};
}

struct PublishedScene {
  PathScene scene;
  int max_depth, iterations;
  double useful;  ///< largest standard error of the mean, relative
  friend std::ostream& operator<<(std::ostream& out, const PublishedScene& s) {
    return out << s.scene;
  }
};

class AsPublished : public testing::TestWithParam<PublishedScene> {};

TEST_P(AsPublished, IsTheSamePicture) {
  const auto& [scene, max_depth, iterations, useful] = GetParam();
  RenderSettings plain = published_picture(test::path_tracing(max_depth), 4 * iterations);
  plain.seed = 2;
  const Rendering expected = render(load(scene), plain);
  for (const Method& method : as_published(max_depth)) {
    SCOPED_TRACE(method);
    expect_same_picture(render(load(scene), published_picture(method.settings, iterations)),
                        expected, useful);
  }
}

INSTANTIATE_TEST_SUITE_P(All, AsPublished,
                         testing::Values(PublishedScene{{"cornell"}, 4, 60, 0.05},
                                         PublishedScene{{"ajar"}, 4, 80, 0.2}),
                         [](const auto& a) { return a.param.scene.name; });
INSTANTIATE_TEST_SUITE_P(Long, AsPublished,
                         testing::Values(PublishedScene{{"sides"}, 4, 100, 0.04},
                                         PublishedScene{{"atrium"}, 5, 120, 0.1}),
                         [](const auto& a) { return a.param.scene.name; });

// Emitters that are hit and emitters that are sampled share each path: weights that do not add up
// to 1 would show where both techniques find much, in the light of a large lamp nearby.
TEST(Heuristics, DifferInNoiseOnly) {
  const PathScene scene{"area"};
  PathSettings power = test::path_tracing(3), balance = power;
  balance.heuristic = Heuristic::balance;
  const Rendering a = render(load(scene), published_picture(power, 400)),
                  b = render(load(scene), published_picture(balance, 400));
  EXPECT_NE(a.film.mean(), b.film.mean());
  const auto x = test::mean_over_iterations(a), y = test::mean_over_iterations(b);
  // The paths are the same: their difference is the weights'.
  EXPECT_NEAR(x.mean(), y.mean(), 0.01 * x.mean());
}

}  // namespace
}  // namespace lacuna
