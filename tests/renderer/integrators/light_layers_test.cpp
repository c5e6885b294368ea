// The light by length and by expression: of every integrator it adds up to the picture, does not
// change it, and has the same means.

#include <gtest/gtest.h>

#include <map>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/plates.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::Method;
using test::Session;

constexpr int longest = 5;

/// No two of these match one path, and one matches each.
const std::vector<LightPathsLayer> partition{{"EL", "seen"},
                                             {"E[DG]L", "direct"},
                                             {"ES+L", "seen_mirrored"},
                                             {"L<RS>+DE", "caustics"},
                                             {"ED.*<T.>L", "window"},
                                             {"!(EL|E[DG]L|ES+L|ED<RS>+L|ED.*<T.>L)", "others"}};

std::vector<Method> all_methods() {
  std::vector<Method> all = test::connections(longest);
  all.push_back({"path", test::path_tracing(longest)});
  PathSettings hits = test::path_tracing(longest);
  hits.next_event_estimation = false;
  all.push_back({"path_without_next_event", hits});
  PathSettings sharing = test::path_tracing(longest);
  sharing.reuse = 16;
  all.push_back({"path_reuse", sharing});
  PathSettings guided = test::path_tracing(longest);
  guided.guide = test::in_small_pictures(SdTreeGuideSettings{});
  all.push_back({"path_sd_tree", guided});
  all.push_back({"light", test::light_tracing(longest)});
  for (Method& m : test::merging(longest)) all.push_back(std::move(m));
  for (Method& m : test::metropolis(longest)) all.push_back(std::move(m));
  for (Method& m : test::many_lights(longest)) all.push_back(std::move(m));
  for (Method& m : test::approximate_lights(longest)) all.push_back(std::move(m));
  return all;
}

test::RenderSettings layered(const Method& method) {
  test::RenderSettings s{.integrator = method.settings, .width = 16, .height = 12};
  if (without_lengths(method.settings).empty()) s.layers = {ImageLayer::lengths};
  if (without_letters(method.settings).empty()) s.light = partition;
  return s;
}

class LightByPath : public testing::TestWithParam<Method> {};

TEST_P(LightByPath, AddsUpToThePictureThatItDoesNotChange) {
  for (const char* scene : {"glass.glb", "cornell.glb"}) {
    const test::RenderSettings settings = layered(GetParam());
    test::RenderSettings without = settings;
    without.layers.clear();
    without.light.clear();
    Session session(load_gltf(test::own_scene(scene)), settings);
    Session plain(load_gltf(test::own_scene(scene)), without);
    for (std::uint64_t i = 0; i < 3; ++i) {
      const Image image = session.iterate(i);
      EXPECT_EQ(image.pixels, plain.iterate(i).pixels) << "layers change the picture";
      double light = 0;
      for (std::size_t p = 0; p < image.pixels.size(); ++p) {
        std::map<bool, V3d> sums{{false, V3d(0)}, {true, V3d(0)}};
        double all = 1e-6;
        for (std::size_t k = 0; k < session.layers().size(); ++k) {
          const V3d value(session.layers()[k].pixels[p]);
          sums[session.layer_names()[k].starts_with("light.")] += value;
          all += value.length();
        }
        const V3d picture(image.pixels[p]);
        const double slack = 2e-5 * all;
        if (!settings.layers.empty()) {
          ASSERT_LT((sums[false] - picture).length(), slack) << scene << ", pixel " << p;
        }
        if (!settings.light.empty()) {
          ASSERT_LT((sums[true] - picture).length(), slack) << scene << ", pixel " << p;
        }
        light += picture.length();
      }
      EXPECT_GT(light, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, LightByPath, testing::ValuesIn(all_methods()),
                         [](const auto& m) { return m.param.name; });

/// The sums of the layers over the picture, iteration by iteration.
std::map<std::string, Moments> sums_of(const IntegratorSettings& settings, const char* scene,
                                       int iterations, std::uint64_t seed) {
  test::RenderSettings s = layered({"", settings});
  s.seed = seed;
  s.width = s.height = 10;
  Session session(load_gltf(test::own_scene(scene)), s);
  std::map<std::string, Moments> sums;
  for (int i = 0; i < iterations; ++i) {
    session.iterate(static_cast<std::uint64_t>(i));
    for (std::size_t k = 0; k < session.layers().size(); ++k) {
      sums[session.layer_names()[k]].add(test::sum_of(session.layers()[k]));
    }
  }
  return sums;
}

TEST(LightByPath, HasTheSameMeansWithEveryUnbiasedMethod) {
  for (const char* scene : {"glass.glb", "cornell.glb"}) {
    const auto expected = sums_of(test::path_tracing(longest), scene, 800, 2);
    std::vector<Method> methods = test::metropolis(longest);
    methods.resize(2);  // of the others the sums are tested above
    methods.push_back({"bdpt", test::joining(longest, PairedSettings{})});
    methods.push_back({"resampled", test::joining(longest, test::resampled<UniformSettings>(32))});
    PathSettings guided = test::path_tracing(longest);
    guided.guide = test::in_small_pictures(SdTreeGuideSettings{});
    methods.push_back({"guided", guided});
    PathSettings sharing = test::path_tracing(longest);
    sharing.reuse = 16;
    methods.push_back({"sharing", sharing});
    if (scene == std::string("cornell.glb")) {
      methods.push_back({"light", test::light_tracing(longest)});
      methods.push_back({"lights", test::of_length(ManyLightsSettings{}, longest)});
    }
    for (const Method& m : methods) {
      for (const auto& [name, sum] : sums_of(m.settings, scene, 150, 3)) {
        EXPECT_GT(statistics::z_test(sum, expected.at(name)), 1e-6)
            << scene << ", " << m.name << ", " << name << ": " << sum.mean() << " +- "
            << sum.standard_error() << ", not " << expected.at(name).mean() << " +- "
            << expected.at(name).standard_error();
      }
    }
    EXPECT_GT(expected.at("light.direct").mean(), 0);
    EXPECT_GT(expected.at("lengths.5").mean(), 0);
  }
}

}  // namespace
}  // namespace lacuna
