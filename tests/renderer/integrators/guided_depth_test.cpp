// Guided paths of many edges, from the eye and from the lights. Their weights are products of a
// factor per vertex. Without the window of roulette and splitting (path/walk.h) nearly all pictures
// are far too dark, and a rare one far too bright.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/render.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

/// Two rooms with a gap between them, so that every guide finds something to lead to. All walls
/// have albedo 1 and shine with radiance 1: the paths of each number of edges add 1 to every pixel.
SceneData white_furnace() {
  test::SceneParts p;
  Material white = test::diffuse(Rgb(1, 1, 1));
  white.emission = Rgb(1, 1, 1);
  const auto wall = p.material(white);
  p.box({-2.1F, -1, -1}, {2.1F, 1, 1}, false, wall);
  p.box({-0.1F, -0.6F, -1}, {0.1F, 1, 1}, true, wall);
  p.eye({-1.9, 0.3, 0.8}, {0, -0.6, -0.4}, 1.2);
  return std::move(p.data);
}

test::RenderSettings tiny_picture(const IntegratorSettings& method, int seed, int iterations) {
  return {.integrator = method,
          .width = 4,
          .height = 3,
          .iterations = iterations,
          .seed = static_cast<std::uint64_t>(seed),
          .threads = 1};
}

/// The mean of a picture over what it should be.
double brightness(test::RenderSettings settings, int depth, int seed) {
  settings.seed = static_cast<std::uint64_t>(seed);
  const test::Rendering r = test::render(white_furnace(), settings);
  EXPECT_EQ(r.counters.rejected, 0U);
  return r.mean() / depth;
}
double brightness(const IntegratorSettings& method, int depth, int seed, int iterations) {
  return brightness(tiny_picture(method, seed, iterations), depth, seed);
}

/// `of(seed)` of the seeds 1 to `n`, two at a time.
template <class Of>
std::vector<double> of_seeds(int n, const Of& of) {
  static const ThreadPool pool(2);
  std::vector<double> values(static_cast<std::size_t>(n));
  pool.for_each(n, [&](int i) { values[static_cast<std::size_t>(i)] = of(i + 1); });
  return values;
}

PathSettings guided_path(const GuideSettings& guide, int depth) {
  PathSettings path{PathLengths{.max_depth = depth}};
  path.guide = guide;
  return path;
}
BdptSettings guided_bdpt(const GuideSettings& guide, int depth) {
  BdptSettings bdpt{PathLengths{.max_depth = depth}};
  bdpt.guide = guide;
  return bdpt;
}

/// Student's test wants sums that are nearly normal: of paths that are not long.
void expect_mean_one(const IntegratorSettings& method, int depth) {
  statistics::Moments all;
  for (const double b : of_seeds(12, [&](int seed) { return brightness(method, depth, seed, 40); }))
    all.add(b);
  EXPECT_GT(statistics::t_test(all, 1), 1e-5) << all.mean() << " +- " << all.standard_error();
  EXPECT_LT(all.standard_error(), 0.02) << "the test has no power";
}

TEST(GuidedDepth, PathTracingHasTheMeanOfAWhiteFurnace) {
  for (const auto& [name, guide] : test::guides()) {
    SCOPED_TRACE(name);
    expect_mean_one(guided_path(guide, 6), 6);
  }
}

TEST(LongGuidedDepth, BidirectionalPathTracingHasTheMeanOfAWhiteFurnace) {
  for (const auto& [name, guide] : test::guides()) {
    SCOPED_TRACE(name);
    expect_mean_one(guided_bdpt(guide, 6), 6);
  }
}

/// Every guide of the registry, which draws nine of ten directions where it has any to draw.
std::vector<std::pair<std::string, GuideSettings>> mostly_guided() {
  std::vector<std::pair<std::string, GuideSettings>> all;
  test::for_each_choice(GuideSettings{}, [&]<class S>(const S& settings) {
    if constexpr (requires(S s) { s.probability = AutoNumber{most_guided}; }) {
      S s = test::in_small_pictures(settings);
      s.probability = AutoNumber{most_guided};
      all.emplace_back(S::name, s);
    }
  });
  return all;
}

// Light that paths find by themselves, so that no other strategy outweighs a wrong density. The
// samples are independent: those of a low-discrepancy sequence avoid the ones before them, of which
// a guide has learned, and sd_tree with leaves of 100 vertices is then 0.2 % too bright.
TEST(LongGuidedDepth, DirectLightFoundByHitsIsRightToAThousandth) {
  constexpr int depth = 2;
  for (const auto& [name, guide] : mostly_guided()) {
    SCOPED_TRACE(name);
    PathSettings path = guided_path(guide, depth);
    path.next_event_estimation = false;
    test::RenderSettings settings = tiny_picture(path, 0, 600);
    settings.width = settings.height = 32;
    statistics::Moments all;
    for (const double b : of_seeds(32, [&](int seed) { return brightness(settings, depth, seed); }))
      all.add(b);
    EXPECT_GT(statistics::t_test(all, 1), 1e-4) << all.mean() << " +- " << all.standard_error();
    EXPECT_LT(all.standard_error(), 0.0002) << "the test has no power";
  }
}

/// Long paths have tails too heavy for Student's test. Counted is how many pictures are below two
/// fifths of what they should be: with the window at most 19 % (of 200 pictures with each guide);
/// without it, or without splitting, 83 to 96 %. A share of a quarter raises a false alarm in one
/// of 50,000 tests, one of 19 % in one of two million.
template <class Brightness>
void expect_few_dark(const Brightness& brightness) {
  constexpr int pictures = 24;
  const std::vector<double> values = of_seeds(pictures, brightness);
  const auto dark = std::count_if(values.begin(), values.end(), [](double b) { return b < 0.4; });
  EXPECT_GT(statistics::binomial_at_least(static_cast<int>(dark), pictures, 0.25), 1e-4)
      << dark << " of " << pictures << " are dark";
}

/// Edges after which a guide's factors have made nearly all pictures dark, without the window.
/// Those of portals differ from 1 at few vertices. Guides that learn their probability learn to be
/// left alone here, where they cannot gain: faults show less in them than in the others.
int long_paths(const GuideSettings& guide) {
  return std::holds_alternative<PortalsGuideSettings>(guide) ? 600 : 200;
}

void expect_few_dark_of_many_edges(const GuideSettings& guide) {
  const int depth = long_paths(guide);
  const PathSettings path = guided_path(guide, depth);
  expect_few_dark([&](int seed) { return brightness(path, depth, seed, 8); });
}
TEST(GuidedDepth, PathTracingOfManyEdgesIsNotDark) {
  expect_few_dark_of_many_edges(test::in_small_pictures(SkeletonGuideSettings{}));
}
TEST(LongGuidedDepth, PathTracingOfManyEdgesIsNotDark) {
  for (const auto& [name, guide] : test::guides()) {
    SCOPED_TRACE(name);
    expect_few_dark_of_many_edges(guide);
  }
}

/// The light of some strategies of a picture by bdpt, unweighted, over what it should be:
/// connections outweigh long paths, and so hide what is wrong with them. `counts`: of the name of a
/// layer.
template <class Counts>
double brightness_of(const Counts& counts, const IntegratorSettings& method, int seed) {
  test::RenderSettings settings = tiny_picture(method, seed, 6);
  settings.layers = {ImageLayer::strategies_unweighted};
  test::Session session(white_furnace(), settings);
  statistics::Moments pixels;
  for (int i = 0; i < settings.iterations; ++i) {
    session.iterate(static_cast<std::uint64_t>(i));
    for (std::size_t k = 0; k < session.layers().size(); ++k) {
      if (!counts(session.layer_names()[k])) continue;
      for (const Rgb& p : session.layers()[k].pixels) pixels.add(double(p.y));
    }
  }
  return pixels.mean();
}

TEST(LongGuidedDepth, BidirectionalPathTracingOfManyEdgesIsNotDark) {
  constexpr int depth = 100;
  for (const GuideSettings& guide :
       {GuideSettings(test::in_small_pictures(SkeletonGuideSettings{})),
        GuideSettings(test::in_small_pictures(FaceIrradianceGuideSettings{})),
        GuideSettings(test::in_small_pictures(SdTreeGuideSettings{}))}) {
    SCOPED_TRACE(std::visit([](const auto& g) { return std::string(g.name); }, guide));
    const auto hits = [](const std::string& name) {
      return name.find(".s0t") != std::string::npos;
    };
    expect_few_dark([&](int seed) { return brightness_of(hits, guided_bdpt(guide, depth), seed); });
  }
}

/// `settings` with light paths that are guided.
template <class S>
IntegratorSettings with_guided_light(S settings) {
  settings.light_guide = SkeletonLightGuideSettings{.probability = 0.5};
  return settings;
}

/// The difference that guided light paths make to the brightness of a picture.
template <class S>
void expect_same_with_guided_light(S settings) {
  SCOPED_TRACE(S::name);
  static_cast<PathLengths&>(settings) = {.max_depth = 12};
  if constexpr (requires { settings.light_paths; }) settings.light_paths = 64;
  constexpr int depth = 12, iterations = 20;
  statistics::Moments all;
  for (const double d : of_seeds(10, [&](int seed) {
         return brightness(with_guided_light(settings), depth, seed, iterations) -
                brightness(settings, depth, seed + 1000, iterations);
       })) {
    all.add(d);
  }
  EXPECT_GT(statistics::t_test(all, 0), 1e-5) << all.mean() << " +- " << all.standard_error();
  EXPECT_LT(all.standard_error(), 0.04) << "the test has no power";
}

TEST(LongGuidedDepth, LightPathsMakeThePictureThatUnguidedOnesMake) {
  expect_same_with_guided_light(LightSettings{});
  expect_same_with_guided_light(BdptSettings{});
  BdptSettings uniform;
  uniform.connections = UniformSettings{};
  expect_same_with_guided_light(uniform);
  expect_same_with_guided_light(VcmSettings{});
  expect_same_with_guided_light(PhotonMapSettings{});
}

TEST(LongGuidedDepth, LightPathsOfManyEdgesAreNotDark) {
  LightSettings light{PathLengths{.max_depth = 100}};
  light.light_paths = 64;
  expect_few_dark([&](int seed) { return brightness(with_guided_light(light), 100, seed, 6); });
  const BdptSettings bdpt{PathLengths{.max_depth = 60}};
  const auto splats = [](const std::string& name) { return name.ends_with("t1"); };
  expect_few_dark([&](int seed) { return brightness_of(splats, with_guided_light(bdpt), seed); });
}

}  // namespace
}  // namespace lacuna
