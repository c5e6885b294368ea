// What files ask of cameras, normals and alpha, by every method: z-tests against path tracing on a
// small room.

#include <gtest/gtest.h>

#include <numbers>

#include "tests/renderer/images/test_images.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using test::Rendering;
using test::SceneParts;

constexpr int longest_path = 3;

/// Adds a texture of one row of RGBA texels, nearest at their centres, and returns a reference.
TextureRef texture(SceneData& data, const std::vector<std::uint8_t>& rgba) {
  const auto width = static_cast<int>(rgba.size() / 4);
  data.textures.push_back(std::make_unique<Texture>("test", test::encode8(width, 1, 4, rgba),
                                                    Texture::Encoding::linear,
                                                    Texture::Wrap::repeat, Texture::Wrap::repeat));
  TextureRef ref;
  ref.texture = static_cast<int>(data.textures.size() - 1);
  return ref;
}

/// A room that is open towards its camera, with a lamp below the ceiling; `wall` and `lamp` are its
/// materials.
SceneParts room(const Material& wall, const Material& lamp) {
  SceneParts p;
  p.box({-1, -1, -1}, {1, 1, 1}, false, p.material(wall));
  p.quad({-0.4F, 0.8F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, p.material(lamp));
  p.quad({-0.6F, -0.4F, -0.5F}, {1.1F, 0.2F, 0}, {0, 0.9F, 0.1F},
         p.material(test::metal(Rgb(0.8F, 0.7F, 0.6F), 0.6F)));
  p.eye({0.3, 0.1, 0.9}, {-0.1, -0.2, -1}, 1.5);
  return p;
}
SceneData plain_room() {
  return std::move(room(test::diffuse(Rgb(0.7F, 0.6F, 0.5F)), test::lamp(Rgb(6, 7, 8))).data);
}

/// All walls and the metal have normals that are bent by up to 60 degrees.
SceneData bent_room() {
  SceneParts p = room(test::plastic(Rgb(0.7F, 0.6F, 0.5F), 0.7F), test::lamp(Rgb(6, 7, 8)));
  const TextureRef map = texture(
      p.data, {230, 128, 170, 255, 40, 60, 190, 255, 128, 240, 160, 255, 128, 128, 255, 255});
  for (Material& m : p.data.materials) {
    if (!m.emits()) m.normal_texture = map;
  }
  return std::move(p.data);
}

/// A lamp, a pane before it, and a metal, all of which are hit with some probability only.
SceneData blended_room() {
  Material lamp = test::lamp(Rgb(6, 7, 8), true);
  lamp.blend = true;
  lamp.alpha = 0.6F;
  SceneParts p = room(test::diffuse(Rgb(0.7F, 0.6F, 0.5F)), lamp);
  Material pane = test::diffuse(Rgb(0.3F, 0.6F, 0.9F));
  pane.blend = true;
  pane.base_color_texture =
      texture(p.data, {255, 255, 255, 60, 255, 255, 255, 120, 255, 255, 255, 220});
  p.quad({-0.8F, -0.1F, -0.7F}, {1.3F, 0, 0}, {0, 0.2F, 1.4F}, p.material(pane));
  return std::move(p.data);
}

SceneData seen_by(const CameraData& kind) {
  SceneData data = plain_room();
  CameraData& camera = data.cameras[0];
  camera.projection = kind.projection;
  camera.height = kind.height;
  camera.aperture = kind.aperture;
  camera.focus = kind.focus;
  camera.blades = kind.blades;
  return data;
}
SceneData through_a_lens() { return seen_by({.aperture = 0.15, .focus = 1.2, .blades = 5}); }
SceneData in_parallel() { return seen_by({.projection = Projection::orthographic, .height = 1.4}); }
SceneData all_around() { return seen_by({.projection = Projection::panorama}); }

struct Feature {
  const char* name;
  SceneData (*scene)();
  friend std::ostream& operator<<(std::ostream& out, const Feature& f) { return out << f.name; }
};

test::RenderSettings picture(const IntegratorSettings& integrator, int iterations) {
  return {.integrator = integrator, .width = 12, .height = 8, .iterations = iterations};
}

class Features : public testing::TestWithParam<Feature> {};

TEST_P(Features, AreSeenAlikeByAllMethods) {
  const auto load = GetParam().scene;
  test::RenderSettings reference = picture(test::path_tracing(longest_path), 240);
  reference.seed = 2;
  const Rendering expected = render(load(), reference);
  std::vector<test::Method> methods{
      {"light", test::light_tracing(longest_path)},
      {"bdpt", test::joining(longest_path, PairedSettings{})},
      {"many_lights", test::lit_by(longest_path, 64, ExactVisibilitySettings{})}};
  PathSettings reuse = test::path_tracing(longest_path);
  reuse.reuse = 16;
  methods.push_back({"reuse", reuse});
  for (const test::Method& method : methods) {
    SCOPED_TRACE(method.name);
    expect_same_picture(render(load(), picture(method.settings, 60)), expected, 0.06);
  }
  for (const test::Method& method : test::metropolis(longest_path)) {
    SCOPED_TRACE(method.name);
    if (method.name.ends_with("apart")) continue;
    expect_same_picture(render(load(), picture(method.settings, 60)), expected, 0.2);
  }
}

// Merging has a bias of its radius, which here is less than a part in thirty.
TEST_P(Features, AreSeenAlikeByMethodsThatMerge) {
  const auto load = GetParam().scene;
  test::RenderSettings reference = picture(test::path_tracing(longest_path), 300);
  reference.seed = 2;
  const double expected = mean_over_iterations(render(load(), reference)).mean();
  VcmSettings merges_only = test::of_length(VcmSettings{}, longest_path);
  merges_only.connect = false;
  SppmSettings photons_only = test::of_length(SppmSettings{}, longest_path);
  photons_only.next_event_estimation = false;
  photons_only.light_paths = 4000;
  for (const test::Method& method :
       std::vector<test::Method>{{"vcm", test::of_length(VcmSettings{}, longest_path)},
                                 {"vcm_merges_only", merges_only},
                                 {"sppm_photons_only", photons_only}}) {
    SCOPED_TRACE(method.name);
    const auto settings = test::fixed_radius(method.settings, 0.02, RadiusUnit::scene);
    const auto m = mean_over_iterations(render(load(), picture(settings, 200)));
    EXPECT_LT(m.standard_error(), 0.03 * expected) << "the test has no power";
    EXPECT_NEAR(m.mean(), expected, expected / 30 + 4 * m.standard_error());
  }
}

INSTANTIATE_TEST_SUITE_P(All, Features,
                         testing::Values(Feature{"BentNormals", bent_room},
                                         Feature{"Blend", blended_room},
                                         Feature{"Lens", through_a_lens},
                                         Feature{"Orthographic", in_parallel},
                                         Feature{"Panorama", all_around}),
                         [](const auto& f) { return f.param.name; });

// Of layers before a white sky, each lets through 1 - alpha.
TEST(Blend, LetsThroughTheProductOfAllLayers) {
  SceneParts p;
  double passes = 1;
  for (const float alpha : {0.2F, 0.5F, 0.7F}) {
    Material black = test::diffuse(Rgb(0, 0, 0));
    black.blend = true;
    black.alpha = alpha;
    p.quad({-9, -9, -1 - alpha}, {18, 0, 0}, {0, 18, 0}, p.material(black));
    passes *= 1 - double(alpha);
  }
  p.quad({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}, p.material(test::lamp(Rgb(1, 1, 1))));
  p.eye({0, 0, 1}, {0, 0, 0}, 0.8);
  const Rendering r = render(std::move(p.data), picture(test::path_tracing(1), 1000));
  const auto m = mean_over_iterations(r);
  EXPECT_LT(m.standard_error(), 0.01 * passes);
  EXPECT_NEAR(m.mean(), passes, 5 * m.standard_error());
}

// The event of a ray depends on nothing but the ray and the triangle.
TEST(Blend, IsTheSameForAnyNumberOfThreads) {
  test::RenderSettings s = picture(test::joining(longest_path, PairedSettings{}), 3);
  s.threads = 1;
  const Rendering one = render(blended_room(), s);
  s.threads = 3;
  EXPECT_EQ(one.film.mean(), render(blended_room(), s).film.mean());
}

TEST(Blend, HasNoFilterWhereNothingPasses) {
  SceneParts p = room(test::diffuse(Rgb(0.5F)), test::lamp(Rgb(1, 1, 1)));
  for (Material& m : p.data.materials) m.blend = true;
  const Rendering r = render(std::move(p.data), picture(test::path_tracing(1), 1));
  EXPECT_EQ(r.filters, 0);
}

}  // namespace
}  // namespace lacuna
