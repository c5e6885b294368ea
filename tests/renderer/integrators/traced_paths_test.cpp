// The paths of a pixel that an observer collects are what the iteration adds to the pixel.

#include <gtest/gtest.h>

#include "renderer/path/path_observer.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/render.h"

namespace lacuna {
namespace {

using test::Method;
using test::Session;

std::vector<Method> traced_methods() {
  std::vector<Method> all = test::guided(5);
  all.push_back({"path", test::path_tracing(5)});
  all.push_back({"light", test::light_tracing(5)});
  all.push_back({"paired", test::joining(5, PairedSettings{})});
  all.push_back({"one_ray", test::joining(5, PairedSettings{.rays = ConnectionRays::one})});
  all.push_back({"towards_eye", test::joining_towards_eye(5, PairedSettings{})});
  return all;
}

class TracedPaths : public testing::TestWithParam<Method> {};

TEST_P(TracedPaths, AddUpToThePixel) {
  constexpr std::uint32_t pixel = 12 * 40 + 19;
  PathObserver observer(pixel);
  test::RenderSettings settings{.integrator = GetParam().settings, .width = 40, .height = 36};
  Session plain(load_gltf(test::own_scene("glass.glb")), settings);
  settings.observer = &observer;
  Session session(load_gltf(test::own_scene("glass.glb")), settings);
  std::size_t paths = 0;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const Rgb expected = plain.iterate(i).pixels[pixel];
    EXPECT_LT((V3d(session.iterate(i).pixels[pixel]) - V3d(expected)).length(),
              1e-5 * V3d(expected).length());
    V3d sum(0);
    for (const TracedPath& p : observer.take()) {
      ++paths;
      sum += V3d(p.value);
      EXPECT_EQ(p.iteration, i);
      EXPECT_EQ(static_cast<int>(p.letters.size()), p.s + p.t);
      if (p.vertices.empty()) continue;
      ASSERT_EQ(p.vertices.size(), p.letters.size());
      EXPECT_EQ(std::ranges::count(p.vertices, true, &TracedVertex::from_light), p.s);
      for (std::size_t k = 1; k < p.vertices.size(); ++k) EXPECT_GT(p.vertices[k].density, 0);
    }
    EXPECT_LT((sum - V3d(expected)).length(), 1e-5 * V3d(expected).length() + 1e-9) << i;
  }
  EXPECT_GT(paths, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, TracedPaths, testing::ValuesIn(traced_methods()),
                         [](const auto& m) { return m.param.name; });

}  // namespace
}  // namespace lacuna
