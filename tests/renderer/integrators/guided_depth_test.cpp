// Guided paths of many edges. Their weights are products of a factor per vertex; without a bound
// their mean over any number of samples stays below what it should be, with a small error estimate.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/render.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

/// A closed box of albedo 1 that shines with radiance 1: a pixel of paths of n edges has value n.
SceneData white_furnace() {
  SceneData data = test::load({"furnace"});
  for (Material& m : data.materials) {
    m.base_color = Rgb(1, 1, 1);
    m.emission = Rgb(1, 1, 1);
  }
  return data;
}

/// Means of pictures of independent seeds.
statistics::Moments means(const IntegratorSettings& method, int iterations) {
  statistics::Moments all;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const test::Rendering r = test::render(white_furnace(), {.integrator = method,
                                                             .width = 8,
                                                             .height = 6,
                                                             .iterations = iterations,
                                                             .camera = "inside",
                                                             .seed = seed});
    all.add(r.mean());
    EXPECT_EQ(r.counters.rejected, 0U);
  }
  return all;
}

void expect_mean(const IntegratorSettings& method, int depth) {
  const statistics::Moments all = means(method, std::max(20, 4000 / depth));
  EXPECT_GT(statistics::t_test(all, depth), 1e-4) << all.mean() << ", expected " << depth;
  // Without a bound the mean is below a third of what it should be.
  EXPECT_LT(all.standard_error(), 0.2 * depth) << "the test has no power";
}

TEST(GuidedDepth, FurnaceOfAlbedoOne) {
  for (const auto& [name, guide] : test::guides()) {
    for (const int depth : {6, 100}) {
      SCOPED_TRACE(testing::Message() << name << ", depth " << depth);
      PathSettings path{PathLengths{.max_depth = depth}};
      path.guide = guide;
      expect_mean(path, depth);
    }
  }
}

TEST(GuidedDepth, ThousandEdges) {
  test::for_each_choice(GuideSettings{}, [&]<class S>(const S& guide) {
    if constexpr (std::is_same_v<S, BsdfGuideSettings>) return;
    SCOPED_TRACE(S::name);
    PathSettings path{PathLengths{.max_depth = 1000}};
    path.guide = guide;
    expect_mean(path, 1000);
  });
}

TEST(GuidedDepth, BidirectionalPathTracing) {
  for (const GuideSettings& guide :
       {GuideSettings(test::in_small_pictures(SkeletonGuideSettings{})),
        GuideSettings(test::in_small_pictures(SdTreeGuideSettings{}))}) {
    BdptSettings bdpt{PathLengths{.max_depth = 20}};
    bdpt.guide = guide;
    expect_mean(bdpt, 20);
  }
}

}  // namespace
}  // namespace lacuna
