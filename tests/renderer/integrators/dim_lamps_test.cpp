// Dim lamps beside a bright one: what the dim ones alone light is as bright as without the other.

#include <gtest/gtest.h>

#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"

namespace lacuna {
namespace {

using test::render;
using test::Rendering;

constexpr int lamps = 15;

/// A floor under dim lamps in one place, seen from above. A lamp `ratio` times as bright as all of
/// them together shines on its underside; 0: there is none.
SceneData floor_between(double ratio) {
  test::GlbBuilder b;
  b.add_node({{"mesh", b.add_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2})}});
  b.add_camera("eye", {0, 2, 0}, 0.6);
  b.json["nodes"].back()["rotation"] = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
  for (int i = 0; i < lamps; ++i) {
    b.add_light({{"type", "point"}, {"intensity", 1.0 / lamps}}, {{"translation", {0, 1, 0}}});
  }
  if (ratio > 0) {
    b.add_light({{"type", "point"}, {"intensity", ratio}}, {{"translation", {0, -1, 0}}});
  }
  return test::load(b);
}

TEST(DimLamps, AreAsBrightAsAlone) {
  std::vector<test::Method> methods = test::connections(2);
  methods.push_back({"path", test::path_tracing(2)});
  methods.push_back({"light", test::light_tracing(2)});
  for (const test::Method& m : methods) {
    SCOPED_TRACE(testing::Message() << m);
    const test::RenderSettings s{.integrator = m.settings, .iterations = 80};
    const statistics::Moments beside = test::mean_over_iterations(render(floor_between(10), s));
    const statistics::Moments alone = test::mean_over_iterations(render(floor_between(0), s));
    const double deviation = std::hypot(beside.standard_error(), alone.standard_error());
    EXPECT_NEAR(beside.mean(), alone.mean(), 4.5 * deviation);
    EXPECT_LT(deviation, 0.05 * alone.mean()) << "the test has no power";
  }
}

// Selection has more steps than 2^24: when it had no more, dim lamps were drawn more often than
// their density told, and this floor was 560 times too bright.
TEST(DimLamps, AreDrawnAsOftenAsTheirDensityTells) {
  PathSettings by_power = test::path_tracing(2);
  by_power.emitters = EmitterChoice::power;
  const test::RenderSettings s{.integrator = by_power, .width = 64, .height = 64};
  const statistics::Moments beside = test::mean_over_iterations(render(floor_between(1e10), s));
  const statistics::Moments alone = test::mean_over_iterations(render(floor_between(0), s));
  const double deviation = std::hypot(beside.standard_error(), alone.standard_error());
  EXPECT_NEAR(beside.mean(), alone.mean(), 4.5 * deviation);
  EXPECT_LT(deviation, 0.05 * alone.mean()) << "the test has no power";
}

}  // namespace
}  // namespace lacuna
