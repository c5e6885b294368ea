// Lights at their extremes, by every kind of method: narrow cones, lamps in the surface that they
// light, powers that differ by decades.

#include <gtest/gtest.h>

#include "renderer/path/unreached_emitters.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::Method;
using test::render;
using test::RenderSettings;
using test::SceneParts;
using Kind = PunctualLight::Kind;

/// Each kind of method once; at depth 2 all light is direct.
std::vector<Method> light_methods(int depth) {
  PhotonMapSettings photons = test::of_length(PhotonMapSettings{}, depth);
  photons.next_event_estimation = false;
  ManyLightsSettings lights = test::lit_by(depth, 200, ExactVisibilitySettings{});
  lights.direct = DirectLighting::lights;
  std::vector<Method> all{{"path", test::path_tracing(depth)},
                          {"light", test::light_tracing(depth, 2000)},
                          {"bdpt", test::joining(depth, PairedSettings{})},
                          {"vcm", test::of_length(VcmSettings{}, depth)},
                          {"photon_map", photons},
                          {"many_lights", lights}};
  for (const Method& m : test::metropolis(depth)) {
    if (m.name.find("direct") == std::string::npos) all.push_back(m);
  }
  return all;
}

/// A camera at `from` that looks straight down.
void look_down(SceneParts& p, const V3d& from, double yfov) {
  CameraData camera;
  camera.yfov = yfov;
  camera.to_world = M44d(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, from.x, from.y, from.z, 1);
  p.data.cameras.push_back(camera);
}

// The floor below a spot, where its whole intensity arrives: albedo / pi I / d^2.
TEST(NarrowSpots, LightTheFloorBelowThem) {
  constexpr double expected = 0.5 / std::numbers::pi * 10 / 4;
  for (const float outer : {0.1F, 1e-2F, 1e-3F, 1e-4F, 1e-5F}) {
    for (const Method& m : light_methods(2)) {
      // Photons resolve no less than 2^-18 of the scene.
      if (outer < 1e-4F && (m.name == "vcm" || m.name == "photon_map")) continue;
      SCOPED_TRACE(testing::Message() << m << ", " << outer << " rad");
      SceneParts p;
      p.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, p.material(test::diffuse(Rgb(0.5F))));
      p.light(Kind::spot, {0, 2, 0}, {0, -1, 0}, Rgb(10));
      p.data.lights.back().outer_cone = outer;
      p.data.lights.back().inner_cone = outer * 0.9F;
      look_down(p, {0, 1.9, 0}, 0.8 * double(outer));
      const auto seen = test::mean_over_iterations(
          render(std::move(p.data),
                 {.integrator = m.settings, .width = 8, .height = 8, .iterations = 32, .seed = 5}));
      // At 0.1 rad the corners are a little further away, and seen at an angle.
      const double slack = (outer > 0.05F ? 0.005 : 1e-4) * expected;
      EXPECT_NEAR(seen.mean(), expected, 4.5 * seen.standard_error() + slack);
      EXPECT_LT(seen.standard_error(), 0.03 * expected) << "the test has no power";
    }
  }
}

/// A floor and a ceiling at y = 2, in which a lamp lies; `below` it where wanted. The camera sees
/// the floor.
SceneData lamp_in_ceiling(Kind kind, float below, bool corner = false) {
  SceneParts p;
  const auto white = p.material(test::diffuse(Rgb(0.6F)));
  p.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, white);
  p.quad({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, white);
  if (corner) p.quad({-2, 0, -2}, {4, 0, 0}, {0, 2, 0}, white);
  p.light(kind, {0.3F, 2 - below, corner ? -2 + below : 0.1F}, {0.2F, -1, 0.1F}, Rgb(5, 4, 3));
  p.data.lights.back().inner_cone = 0.5F;
  p.data.lights.back().outer_cone = 1.2F;
  p.eye({0.1, 1, 3.5}, {0, 0, 0}, 0.5);
  return std::move(p.data);
}

// As from a lamp a little below, but for the ceiling itself, which such a lamp lights.
TEST(LampsInSurfaces, LightWhatIsBelowThem) {
  for (const bool corner : {false, true}) {
    for (const Kind kind : {Kind::point, Kind::spot}) {
      const RenderSettings s{.width = 8, .height = 8, .iterations = 32};
      const auto with = [&](const Method& m) {
        RenderSettings settings = s;
        settings.integrator = m.settings;
        return settings;
      };
      const auto below =
          render(lamp_in_ceiling(kind, 1e-4F, corner), with(light_methods(2).front()));
      for (const Method& m : light_methods(2)) {
        if (m.name == "photon_map") continue;  // its estimate is too blurred and too noisy
        SCOPED_TRACE(testing::Message() << m << ", kind " << int(kind) << ", corner " << corner);
        const auto in = render(lamp_in_ceiling(kind, 0, corner), with(m));
        const auto a = test::mean_over_iterations(in), b = test::mean_over_iterations(below);
        EXPECT_NEAR(a.mean(), b.mean(),
                    4.5 * std::hypot(a.standard_error(), b.standard_error()) + 1e-3 * b.mean());
        EXPECT_LT(a.standard_error(), 0.05 * b.mean()) << "the test has no power";
      }
    }
  }
}

TEST(LampsInSurfaces, AreTheSameToAllMethods) {
  const auto reference = render(lamp_in_ceiling(Kind::point, 0),
                                {.integrator = test::path_tracing(4), .iterations = 64});
  for (const Method& m : light_methods(4)) {
    if (m.name == "path" || m.name == "photon_map") continue;
    SCOPED_TRACE(testing::Message() << m);
    test::expect_same_picture(render(lamp_in_ceiling(Kind::point, 0),
                                     {.integrator = m.settings, .iterations = 32, .seed = 9}),
                              reference, 0.05);
  }
}

constexpr int boxes = 7;

/// Boxes side by side, open to the front, each with a lamp: that of box k has the power
/// `ratio`^k. No light of one reaches another. Each is a seventh of the picture's width.
SceneData lit_boxes(double ratio) {
  SceneParts p;
  const auto white = p.material(test::diffuse(Rgb(0.6F)));
  for (int k = 0; k < boxes; ++k) {
    const V3f o(static_cast<float>(k) - 0.5F * boxes, -0.5F, -1), x(1, 0, 0), y(0, 1, 0),
        z(0, 0, 1);
    p.quad(o, x, y, white);
    p.quad(o, z, x, white);
    p.quad(o + y, x, z, white);
    p.quad(o, y, z, white);
    p.quad(o + x, z, y, white);
    p.light(Kind::point, o + V3f(0.5F, 0.7F, 0.4F), {0, -1, 0},
            Rgb(static_cast<float>(std::pow(ratio, k))));
  }
  p.eye({0, 0, 200}, {0, 0, 0}, 2 * std::atan(0.5 / 200));
  return std::move(p.data);
}

/// The mean of each box's pixels, over iterations.
std::array<statistics::Moments, boxes> means_of_boxes(double ratio,
                                                      const IntegratorSettings& method,
                                                      int iterations) {
  test::Session session(lit_boxes(ratio),
                        {.integrator = method, .width = 4 * boxes, .height = 4, .seed = 3});
  std::array<statistics::Moments, boxes> all;
  for (int i = 0; i < iterations; ++i) {
    std::array<double, boxes> sums{};
    const Image image = session.iterate(static_cast<std::uint64_t>(i));
    for (std::size_t k = 0; k < image.pixels.size(); ++k) {
      sums[k / 4 % boxes] += double(image.pixels[k].x) / 16;
    }
    for (std::size_t k = 0; k < boxes; ++k) all[k].add(sums[k]);
  }
  return all;
}

TEST(PowersOverDecades, LoseNoLightInDimBoxes) {
  for (const Method& m : light_methods(3)) {
    if (m.name.find("direct") != std::string::npos) continue;
    // One chain for all of the picture goes where the light is.
    if (std::holds_alternative<MetropolisSettings>(m.settings)) continue;
    // These merge with photons beyond the walls, which are a hundred times brighter.
    if (m.name == "vcm" || m.name == "photon_map") continue;
    SCOPED_TRACE(testing::Message() << m);
    const auto equal = means_of_boxes(1, m.settings, 32);
    const auto apart = means_of_boxes(100, m.settings, 128);
    for (int k = 0; k < boxes; ++k) {
      const auto& a = apart[static_cast<std::size_t>(k)];
      const auto& b = equal[static_cast<std::size_t>(k)];
      const double power = std::pow(100, k);
      EXPECT_NEAR(a.mean() / power, b.mean(),
                  4.5 * std::hypot(a.standard_error() / power, b.standard_error()))
          << "box " << k;
      EXPECT_LT(a.standard_error() / power, 0.2 * b.mean()) << "the test has no power: box " << k;
    }
  }
}

TEST(UnreachedEmitters, AreWarnedOfWherePathsAreFew) {
  const ThreadPool pool(1);
  for (const double ratio : {1.0, 100.0}) {
    SceneData data = lit_boxes(ratio);
    for (PunctualLight& light : data.lights) light.name = "lamp";
    const Camera camera(data.cameras[0], 4 * boxes, 4);
    const Scene scene = test::lit_scene(std::move(data));
    for (const double paths : {1.0, 1000.0, 1e6}) {
      const auto said = unreached_emitters(scene, camera, paths);
      EXPECT_EQ(said.size(), paths < 10 ? 1U : 0U) << ratio << ", " << paths;
      if (!said.empty()) {
        EXPECT_NE(said[0].find("\"lamp\""), std::string::npos) << said[0];
      }
    }
  }
}

}  // namespace
}  // namespace lacuna
