// Path tracing whose pixels share the light behind their second vertices: the same picture as
// without, less noise, and the same bits for any number of threads.

#include <gtest/gtest.h>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"

namespace lacuna {
namespace {

using test::Rendering;
using test::RenderSettings;

PathSettings sharing(int pixels, PathLengths lengths) {
  PathSettings path{lengths};
  path.reuse = pixels;
  return path;
}

struct Shared {
  test::PathScene scene;
  int max_depth;
  int pixels;
  int iterations;
  double useful = 0.02;
  friend std::ostream& operator<<(std::ostream& out, const Shared& s) { return out << s.scene; }
};

class PathReuse : public testing::TestWithParam<Shared> {};

// The film is no multiple of a block, so that groups are of all sizes.
TEST_P(PathReuse, HasThePictureOfOthers) {
  const Shared& shared = GetParam();
  RenderSettings s{.integrator = test::path_tracing(shared.max_depth),
                   .width = 20,
                   .height = 12,
                   .iterations = 4 * shared.iterations,
                   .environment = environment(shared.scene)};
  const Rendering expected = test::render(test::load(shared.scene), s);
  s.seed = 2;
  s.iterations = shared.iterations;
  s.integrator = sharing(shared.pixels, test::whole_paths(shared.max_depth));
  test::expect_same_picture(test::render(test::load(shared.scene), s), expected, shared.useful);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, PathReuse,
    testing::Values(Shared{{"cornell"}, 5, 16, 400}, Shared{{"cornell"}, 3, 3, 400},
                    Shared{{"glass"}, 5, 16, 400}, Shared{{"mirror"}, 4, 8, 600, 0.025},
                    Shared{{"coated"}, 4, 64, 300}, Shared{{"leaning"}, 5, 16, 400, 0.03},
                    Shared{{"point"}, 4, 16, 300}, Shared{{"sides"}, 4, 16, 400},
                    Shared{{"open", true}, 4, 16, 400, 0.04},
                    Shared{{"furnace_sphere"}, 3, 64, 200}, Shared{{"atrium"}, 5, 64, 200, 0.04},
                    Shared{{"ajar"}, 5, 64, 300, 0.07}),
    [](const auto& s) { return s.param.scene.name + "_" + std::to_string(s.param.pixels); });

/// A floor, diffuse if not given, in a room of `wall`, whose lamp shines to the ceiling: all that
/// the eye sees came by a second surface of `wall`, and differs from pixel to pixel.
SceneData lit_from_walls(const Material& wall, const Material& floor = test::diffuse(Rgb(0.8F))) {
  test::SceneParts p;
  p.box({0, 0, 0}, {3, 2, 4}, false, p.material(wall));
  p.quad({0, 0.01F, 0}, {0, 0, 4}, {3, 0, 0}, p.material(floor));
  p.quad({1.3F, 1.4F, 2.8F}, {0, 0, 0.4F}, {0.4F, 0, 0}, p.material(test::lamp(Rgb(30, 30, 30))));
  p.eye({1.5, 1, 2.5}, {1.5, 0, 1}, 1.8);
  return std::move(p.data);
}

// A second surface of gloss scatters to each pixel what it scatters there, and no more; one that is
// partly a mirror shares the rest.
TEST(LongPathReuse, HasThePictureOfOthersWithGloss) {
  for (const float roughness : {0.5F, 0.0F}) {
    SCOPED_TRACE(roughness);
    Material wall = test::diffuse(Rgb(0.8F, 0.7F, 0.6F));
    wall.metallic = roughness > 0 ? 1.0F : 0.6F;
    wall.roughness = roughness;
    RenderSettings s{.integrator = test::path_tracing(4), .iterations = 12000};
    s.width = s.height = 8;
    const Rendering expected = test::render(lit_from_walls(wall), s);
    s.seed = 2;
    s.iterations = 6000;
    s.integrator = sharing(16, test::whole_paths(4));
    test::expect_same_picture(test::render(lit_from_walls(wall), s), expected, 0.03);
  }
}

// Roulette goes by the throughput of the whole path.
TEST(PathReuse, AndRouletteHaveThePictureOfOthers) {
  RenderSettings s{.integrator = test::path_tracing(12), .iterations = 800};
  const Rendering expected = test::render("cornell.glb", s);
  s.seed = 2;
  s.integrator = sharing(16, {.max_depth = 12, .roulette_depth = 2});
  s.iterations = 400;
  const Rendering found = test::render("cornell.glb", s);
  test::expect_same_picture(found, expected, 0.02);
  PathSettings plain{PathLengths{.max_depth = 12, .roulette_depth = 2}};
  s.integrator = plain;
  const double rays = double(test::render("cornell.glb", s).counters.rays);
  EXPECT_NEAR(double(found.counters.rays) / rays, 1.0, 0.02) << "paths end elsewhere";
}

// Guided paths share what they gather, with the densities of their guide.
TEST(LongPathReuse, AndGuidesHaveThePictureOfOthers) {
  RenderSettings s{
      .integrator = test::path_tracing(5), .width = 20, .height = 12, .iterations = 2000};
  const Rendering expected = test::render("ajar.glb", s);
  s.seed = 2;
  s.iterations = 400;
  for (const auto& [name, guide] : test::guides()) {
    SCOPED_TRACE(name);
    PathSettings path = sharing(16, test::whole_paths(5));
    path.guide = guide;
    s.integrator = path;
    test::expect_same_picture(test::render("ajar.glb", s), expected, 0.07);
  }
}

// Where a guide adds much to the weight of paths they are split, behind the vertex that pixels
// share; those of a batch that come from a mirror and share nothing, too. In a closed room all
// other paths are equally long.
TEST(LongPathReuse, AndSplitPathsHaveThePictureOfOthers) {
  Material wall = test::diffuse(Rgb(0.8F, 0.7F, 0.6F)), floor = test::diffuse(Rgb(0.8F));
  wall.metallic = floor.metallic = 0.6F;
  wall.roughness = 0.5F;
  floor.roughness = 0;
  constexpr int iterations = 14000;
  RenderSettings s{.integrator = test::path_tracing(8), .iterations = iterations};
  s.width = s.height = 8;
  const Rendering expected = test::render(lit_from_walls(wall, floor), s);
  s.seed = 2;
  PathSettings path = sharing(16, test::whole_paths(8));
  SkeletonGuideSettings skeleton;
  skeleton.probability = AutoNumber{0.8};
  skeleton.strength = AutoNumber{20};
  path.guide = skeleton;
  s.integrator = path;
  const Rendering found = test::render(lit_from_walls(wall, floor), s);
  test::expect_same_picture(found, expected, 0.01);
  EXPECT_GT(double(found.counters.rays), 1.1 * double(expected.counters.rays))
      << "paths are hardly split";
}

/// Sums of the squared differences between two pictures of so many iterations, of `seeds` pairs.
std::vector<double> noises(const PathSettings& path, const RenderSettings& like, int seeds) {
  std::vector<double> all;
  for (int k = 0; k < seeds; ++k) {
    RenderSettings s = like;
    s.integrator = path;
    std::array<std::vector<double>, 2> means;
    for (std::size_t half = 0; half < 2; ++half) {
      s.seed = static_cast<std::uint64_t>(2 * k) + half + 1;
      means[half] = test::render("bends.glb", s).film.mean();
    }
    double sum = 0;
    for (std::size_t i = 0; i < means[0].size(); ++i) {
      sum += (means[0][i] - means[1][i]) * (means[0][i] - means[1][i]);
    }
    all.push_back(std::log(sum));
  }
  return all;
}

// Where paths seldom find light, pixels that share it have much less noise: in small pictures, by
// significance over seeds, less than a third of it.
TEST(PathReuse, SavesNoise) {
  const RenderSettings like{.width = 32, .height = 24, .iterations = 16};
  constexpr int seeds = 8;
  const std::vector<double> alone = noises(test::path_tracing(6), like, seeds);
  const std::vector<double> shared = noises(sharing(16, test::whole_paths(6)), like, seeds);
  statistics::Moments gain;
  for (int k = 0; k < seeds; ++k) gain.add(alone[std::size_t(k)] - shared[std::size_t(k)]);
  EXPECT_GT(gain.mean() - 3 * gain.standard_error(), std::log(3.0))
      << gain.mean() << " +- " << gain.standard_error();
}

TEST(PathReuse, OfOnePixelIsNone) {
  RenderSettings s{.integrator = test::path_tracing(5), .iterations = 4};
  const Rendering plain = test::render("cornell.glb", s);
  s.integrator = sharing(1, test::whole_paths(5));
  EXPECT_EQ(test::render("cornell.glb", s).film.mean(), plain.film.mean());
}

// Nothing is shared behind the second vertex of paths that end there.
TEST(PathReuse, LeavesDirectLight) {
  RenderSettings s{.integrator = test::path_tracing(2), .iterations = 4};
  const Rendering plain = test::render("cornell.glb", s);
  s.integrator = sharing(64, test::whole_paths(2));
  const Rendering shared = test::render("cornell.glb", s);
  EXPECT_EQ(shared.film.mean(), plain.film.mean());
  EXPECT_EQ(shared.counters.shadow_rays, plain.counters.shadow_rays);
}

}  // namespace
}  // namespace lacuna
