// Thin walls, absorbing solids and the lobes of glTF's extensions: exact values, and the same
// picture by all methods.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::Method;
using test::Rendering;
using test::SceneParts;

Material absorbing(Material m, const Rgb& extinction) {
  m.extensions.volume = {true, {extinction}};
  return m;
}

/// A closed room whose walls all emit radiance 1, with an eye at the origin that looks along -z.
SceneParts furnace() {
  SceneParts p;
  p.box({-4, -4, -4}, {4, 4, 4}, false, p.material(test::lamp(Rgb(1, 1, 1))));
  p.eye({0, 0, 0}, {0, 0, -1}, 0.01);
  return p;
}

Rendering through(SceneParts p, const IntegratorSettings& integrator) {
  return test::render(std::move(p.data),
                      {.integrator = integrator, .width = 8, .height = 8, .iterations = 64});
}

TEST(ThinWall, PassesAllLightFromBothSides) {
  for (const bool front : {true, false}) {
    for (const float roughness : {0.0F, 0.3F}) {
      SceneParts p = furnace();
      const V3f a(2, 0, 0), b(0, 2, 0);
      p.quad({-1, -1, -1}, front ? a : b, front ? b : a, p.material(test::window(roughness)));
      const Rendering r = through(std::move(p), test::path_tracing(8));
      // Rough facets lose what they would scatter twice.
      EXPECT_NEAR(r.mean(), 1, roughness == 0 ? 1e-5 : 0.01) << front << " " << roughness;
    }
  }
}

/// Without a boundary only the medium is left: Beer and Lambert's law, for a slab of thickness 1,
/// with the eye before it and with the eye inside.
TEST(Medium, AbsorbsAlongTheWayInside) {
  Material clear = test::glass();
  clear.ior = 1;
  const Rgb extinction(0.5F, 1, 2);
  for (const bool inside : {false, true}) {
    const double length = inside ? 2 : 1;
    for (const IntegratorSettings& integrator :
         {IntegratorSettings{test::path_tracing(6)}, {test::joining(6, PairedSettings{})}}) {
      SceneParts p = furnace();
      p.box({-2, -2, -2}, {2, 2, inside ? 1.0F : -1.0F}, true,
            p.material(absorbing(clear, extinction)));
      const std::vector<double> mean = through(std::move(p), integrator).film.mean();
      for (std::size_t c = 0; c < 3; ++c) {
        const double expected = std::exp(-length * double(extinction[static_cast<int>(c)]));
        EXPECT_NEAR(mean[c], expected, 1e-4) << inside << " " << c;
      }
    }
  }
}

/// A room with rough solids that absorb, one of them around an opaque box, a thin rough wall, and
/// surfaces with the further lobes. Nothing is smooth, so that every method sees all.
SceneData room_of_lobes() {
  SceneParts p;
  Material cloth = test::diffuse(Rgb(0.5F, 0.5F, 0.6F));
  cloth.extensions.sheen.color = Rgb(0.8F, 0.7F, 0.6F);
  cloth.extensions.sheen.roughness = 0.5F;
  cloth.extensions.coat.factor = 0.7F;
  cloth.extensions.coat.roughness = 0.4F;
  p.box({0, 0, 0}, {3, 2, 4}, false, p.material(cloth));
  p.box({0.4F, 0.1F, 0.8F}, {1.2F, 1.1F, 1.8F}, true,
        p.material(absorbing(test::glass(0.4F), Rgb(0.5F, 1.5F, 3))));
  p.box({0.7F, 0.3F, 1.1F}, {0.9F, 0.8F, 1.5F}, true,
        p.material(test::diffuse(Rgb(0.8F, 0.8F, 0.8F))));
  Material brushed = test::metal(Rgb(0.9F, 0.8F, 0.6F), 0.4F);
  brushed.extensions.anisotropy.strength = 0.7F;
  brushed.extensions.anisotropy.rotation = 0.5F;
  brushed.extensions.iridescence.factor = 1;
  p.quad({2.9F, 0.2F, 0.5F}, {0, 1.5F, 0}, {0, 0, 2}, p.material(brushed));
  Material leaf = test::plastic(Rgb(0.4F, 0.6F, 0.3F), 0.6F);
  leaf.extensions.diffuse_transmission.factor = 0.6F;
  leaf.extensions.diffuse_transmission.color = Rgb(0.7F, 0.9F, 0.4F);
  p.quad({1.7F, 0.2F, 1}, {0.7F, 0, 0.3F}, {0, 1, 0}, p.material(leaf));
  p.quad({0.3F, 1.4F, 0.5F}, {2.2F, 0, 0}, {0, 0.2F, 2.5F}, p.material(test::window(0.5F)));
  p.quad({1, 1.9F, 1}, {1, 0, 0}, {0, 0, 1}, p.material(test::lamp(Rgb(3, 4, 5))));
  p.eye({1.5, 0.9, 3.8}, {1.4, 0.7, 0}, 1.1);
  return std::move(p.data);
}

TEST(Lobes, AreTheSameByAllMethods) {
  constexpr int max_depth = 6, iterations = 60;
  const auto settings = [](const IntegratorSettings& integrator, int n) {
    return test::RenderSettings{
        .integrator = integrator, .width = 16, .height = 10, .iterations = n};
  };
  test::RenderSettings reference = settings(test::path_tracing(max_depth), 6 * iterations);
  reference.seed = 2;
  const Rendering expected = test::render(room_of_lobes(), reference);
  PathSettings reused = test::path_tracing(max_depth);
  reused.reuse = 16;
  std::vector<Method> methods{{"path, reuse", reused},
                              {"light", test::light_tracing(max_depth)},
                              {"bdpt", test::joining(max_depth, PairedSettings{})}};
  for (const Method& m : test::merging(max_depth)) {
    if (m.name == "vcm" || m.name == "sppm") methods.push_back(m);
  }
  for (const Method& m : test::metropolis(max_depth)) methods.push_back(m);
  methods.push_back(test::many_lights(max_depth).front());
  for (Method& method : methods) {
    SCOPED_TRACE(method);
    test::expect_same_picture(test::render(room_of_lobes(), settings(method.settings, iterations)),
                              expected, 0.05);
  }
}

}  // namespace
}  // namespace lacuna
