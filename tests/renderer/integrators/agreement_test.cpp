// Every way to make a picture makes the same one: z-tests of its mean and of the means of its
// blocks, with the noise of both.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::expect_same_picture;
using test::mean_over_iterations;
using test::Method;
using test::PathScene;
using test::Rendering;
using test::RenderSettings;

struct Agreement {
  PathScene scene;
  int max_depth;
  /// Of path tracing and bdpt; four times as many of the reference, half of Metropolis, a third of
  /// many lights, whose iterations have less noise.
  int iterations;
  /// Nothing is seen through mirrors or clear glass, so that light tracing sees it too.
  bool light = true;
  double useful = 0.01;  ///< largest standard error of the mean, relative
  friend std::ostream& operator<<(std::ostream& out, const Agreement& a) { return out << a.scene; }
};

const std::vector<Agreement> agreements{
    {{"cornell"}, 5, 200, true, 0.015},
    {{"glass"}, 5, 120, false, 0.015},
    {{"mirror"}, 4, 400, false, 0.025},
    {{"point"}, 3, 150, true, 0.015},
    {{"spot"}, 3, 150},
    {{"sides"}, 4, 200},
    {{"open", true}, 4, 250, false, 0.04},
    {{"ajar"}, 5, 150, false, 0.07},
    {{"atrium"}, 5, 120, true, 0.04},
    {{"coated"}, 4, 120, false},
};
const std::vector<Agreement> more_agreements{
    {{"furnace_sphere"}, 3, 200},
    {{"directional"}, 3, 150, true, 0.015},
    {{"area"}, 4, 200},
    {{"leaning"}, 5, 240, true, 0.035},
    {{"bends"}, 7, 120, true, 0.07},
    {{"many_lights"}, 4, 400, true, 0.07},
};

constexpr int columns = 20, rows = 12;

RenderSettings small_picture(const PathScene& scene, const IntegratorSettings& integrator,
                             int iterations) {
  return {.integrator = integrator,
          .width = columns,
          .height = rows,
          .iterations = iterations,
          .environment = environment(scene)};
}

/// The picture that others are held against, of random numbers of its own.
Rendering reference(const PathScene& scene, RenderSettings settings) {
  settings.iterations *= 4;
  settings.seed = 2;
  return render(load(scene), settings);
}

class Agrees : public testing::TestWithParam<Agreement> {};

TEST_P(Agrees, WithPathTracing) {
  const Agreement& a = GetParam();
  const Rendering expected =
      reference(a.scene, small_picture(a.scene, test::path_tracing(a.max_depth), a.iterations));
  std::vector<Method> methods = test::connections(a.max_depth);
  if (a.light) {
    methods.push_back({"light", test::light_tracing(a.max_depth)});
    methods.push_back({"light, 500 paths", test::light_tracing(a.max_depth, 500)});
    methods.push_back({"light, towards the eye", test::light_towards_eye(a.max_depth)});
    methods.push_back(
        {"paired, towards the eye", test::joining_towards_eye(a.max_depth, PairedSettings{})});
    methods.push_back(
        {"resampled, towards the eye",
         test::joining_towards_eye(a.max_depth, test::resampled<UniformSettings>(64))});
  }
  for (const Method& method : methods) {
    SCOPED_TRACE(method.name);
    // Guided past what it does not know, light leaves a few strong paths; and one connection of any
    // length is fewer than one of each length.
    const bool noisier = method.name == "light, towards the eye" || method.name == "probabilistic";
    const double useful = noisier ? 1.5 * a.useful : a.useful;
    expect_same_picture(
        render(load(a.scene), small_picture(a.scene, method.settings, a.iterations)), expected,
        useful);
  }
}

TEST_P(Agrees, Metropolis) {
  const Agreement& a = GetParam();
  const Rendering expected =
      reference(a.scene, small_picture(a.scene, test::path_tracing(a.max_depth), a.iterations));
  for (const Method& method : test::metropolis(a.max_depth)) {
    SCOPED_TRACE(method.name);
    expect_same_picture(
        render(load(a.scene), small_picture(a.scene, method.settings, a.iterations / 2)), expected,
        5 * a.useful);
  }
}

TEST_P(Agrees, ManyLights) {
  const Agreement& a = GetParam();
  const Rendering expected =
      reference(a.scene, small_picture(a.scene, test::path_tracing(a.max_depth), a.iterations));
  // Few light paths from the sky come through: only over many iterations is their mean normal.
  const int iterations = a.scene.sky ? a.iterations : a.iterations / 3;
  for (const Method& method : test::many_lights(a.max_depth)) {
    SCOPED_TRACE(method.name);
    expect_same_picture(render(load(a.scene), small_picture(a.scene, method.settings, iterations)),
                        expected, 3 * a.useful, method.name == "lights_probabilistic");
  }
}

INSTANTIATE_TEST_SUITE_P(All, Agrees, testing::ValuesIn(agreements),
                         [](const auto& a) { return a.param.scene.name; });
INSTANTIATE_TEST_SUITE_P(Long, Agrees, testing::ValuesIn(more_agreements),
                         [](const auto& a) { return a.param.scene.name; });

struct Unusual {
  PathScene scene;
  int iterations;
  double useful;
};

// Flags change what is drawn how often, never what is expected.
TEST(Agree, AllFlagsOfConnections) {
  constexpr int max_depth = 4;
  for (const auto& [scene, iterations, useful] :
       {Unusual{{"coated"}, 60, 0.02}, Unusual{{"open", true}, 60, 0.12}}) {
    const Rendering expected =
        reference(scene, small_picture(scene, test::path_tracing(max_depth), 2 * iterations));
    for (const Method& method : test::unusual_connections(max_depth)) {
      SCOPED_TRACE(testing::Message() << scene << ", " << method);
      expect_same_picture(render(load(scene), small_picture(scene, method.settings, iterations)),
                          expected, useful);
    }
  }
}

// Selecting emitters by a light tree: area, point and spot lights, from one side and both, light
// from infinity, glass, mirrors, few emitters and many.
TEST(Agree, EmittersByTheTree) {
  constexpr int max_depth = 4;
  for (const auto& [scene, iterations, useful] :
       {Unusual{{"many_lights"}, 600, 0.07}, Unusual{{"area"}, 100, 0.02},
        Unusual{{"sides"}, 150, 0.02}, Unusual{{"spot"}, 100, 0.02}, Unusual{{"glass"}, 100, 0.03},
        Unusual{{"coated"}, 100, 0.02}, Unusual{{"open", true}, 100, 0.1},
        Unusual{{"directional"}, 50, 0.03}, Unusual{{"furnace_sphere"}, 50, 0.02}}) {
    PathSettings by_power = test::path_tracing(max_depth);
    by_power.emitters = EmitterChoice::power;
    const Rendering expected = reference(scene, small_picture(scene, by_power, iterations));
    PathSettings path = test::path_tracing(max_depth);
    path.emitters = EmitterChoice::tree;
    const BdptSettings bdpt = test::joining(max_depth, PairedSettings{EmitterChoice::tree});
    for (const IntegratorSettings& integrator : {IntegratorSettings{path}, {bdpt}}) {
      SCOPED_TRACE(testing::Message() << scene << ", " << integrator.index());
      expect_same_picture(render(load(scene), small_picture(scene, integrator, iterations)),
                          expected, useful);
    }
  }
}

// No path from the eye finds the reflection of a point of light: here bdpt agrees with itself.
TEST(Agree, ReflectionsOfPoints) {
  const PathScene scene{"coated_points"};
  const std::vector<Method> methods = test::connections(4);
  const Rendering expected = reference(scene, small_picture(scene, methods[0].settings, 400));
  for (std::size_t i = 1; i < methods.size(); ++i) {
    SCOPED_TRACE(methods[i]);
    expect_same_picture(render(load(scene), small_picture(scene, methods[i].settings, 120)),
                        expected, 0.015);
  }
  const Rendering without = reference(scene, small_picture(scene, test::path_tracing(4), 1250));
  const statistics::Moments lacks = mean_over_iterations(without),
                            has = mean_over_iterations(expected);
  EXPECT_LT(lacks.mean(), has.mean());
  // They are one part in a hundred of the light, with a standard error of a sixth of that.
  EXPECT_LT(statistics::t_test(lacks, has), 0.02)
      << lacks.mean() << " +- " << lacks.standard_error() << " is not less than " << has.mean()
      << " +- " << has.standard_error();
}

TEST(Agree, ThroughATentFilter) {
  for (const char* name : {"cornell", "sides"}) {
    const PathScene scene{name};
    const auto picture = [&](const IntegratorSettings& integrator) {
      RenderSettings s = small_picture(scene, integrator, 150);
      s.filter = PixelFilter::tent;
      return s;
    };
    const Rendering expected = reference(scene, picture(test::path_tracing(4)));
    std::vector<Method> methods = test::connections(4);
    methods.push_back({"light", test::light_tracing(4)});
    for (const Method& method : methods) {
      SCOPED_TRACE(testing::Message() << name << ", " << method);
      expect_same_picture(render(load(scene), picture(method.settings)), expected, 0.02);
    }
    // A tent is no box: the test sees the difference.
    RenderSettings box = picture(test::path_tracing(4));
    box.filter = PixelFilter::box;
    EXPECT_NE(render(load(scene), box).film.mean(), expected.film.mean());
  }
}

// Roulette on either walk changes nothing.
TEST(Agree, WhereRouletteEndsWalksEarly) {
  const PathScene scene{"cornell"};
  const Rendering expected = reference(scene, small_picture(scene, test::path_tracing(8), 200));
  std::vector<Method> methods = test::connections(8);
  methods.push_back({"light", test::light_tracing(8)});
  methods.push_back({"light, towards the eye", test::light_towards_eye(8)});
  methods.push_back({"paired, towards the eye", test::joining_towards_eye(8, PairedSettings{})});
  for (Method& method : methods) {
    SCOPED_TRACE(method);
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.roulette_depth; }) s.roulette_depth = 1;
        },
        method.settings);
    expect_same_picture(render(load(scene), small_picture(scene, method.settings, 200)), expected,
                        0.02);
  }
}

}  // namespace
}  // namespace lacuna
