// What integrator `inspect` shows.

#include <gtest/gtest.h>

#include <set>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/integrators/render.h"

namespace lacuna {
namespace {

using test::render;
using test::Rendering;

InspectSettings showing(InspectQuantity q) { return {q}; }

TEST(Inspect, ShowsWhatItSays) {
  // The floor of `point.glb` seen from straight above: one normal, a known depth in the middle.
  const Rendering normal = render("point.glb", {.integrator = showing(InspectQuantity::normal),
                                                .width = 9,
                                                .height = 9,
                                                .iterations = 1,
                                                .camera = "above"});
  const std::vector<double> n = normal.film.mean();
  for (std::size_t i = 0; i < n.size(); i += 3) {
    EXPECT_NEAR(n[i + 1], 1, 1e-6);
    EXPECT_NEAR(n[i], 0, 1e-6);
  }
  const SceneData scene = load_gltf(test::own_scene("point.glb"));
  const double height = scene.cameras.front().to_world[3][1];
  const Rendering depth = render("point.glb", {.integrator = showing(InspectQuantity::depth),
                                               .width = 9,
                                               .height = 9,
                                               .iterations = 64,
                                               .camera = "above"});
  EXPECT_NEAR(depth.film.mean()[3 * (4 * 9 + 4)], height, 0.01 * height);
  const Rendering albedo = render("point.glb", {.integrator = showing(InspectQuantity::albedo),
                                                .width = 9,
                                                .height = 9,
                                                .iterations = 1,
                                                .camera = "above"});
  for (const double v : albedo.film.mean()) EXPECT_NEAR(v, 0.5, 1e-6);
}

/// One value for each pixel: all three channels are the same.
std::vector<double> picture_of_guide(InspectQuantity quantity, const GuideSettings& guide,
                                     int learn, int threads = 2) {
  InspectSettings s{quantity, guide, learn};
  const Rendering r =
      render("ajar.glb", {.integrator = s, .iterations = 1, .camera = "room", .threads = threads});
  return r.film.mean();
}

std::set<double> values(const std::vector<double>& picture) {
  return {picture.begin(), picture.end()};
}

TEST(InspectGuide, ShowsTheProbabilityThatIsSet) {
  SkeletonGuideSettings skeleton;
  skeleton.probability = {0.25};
  const auto seen = values(picture_of_guide(InspectQuantity::guide_probability, skeleton, 0));
  EXPECT_TRUE(seen.contains(0.25));
  EXPECT_LE(seen.size(), 2U) << "and 0, where a surface has no node";
  const auto bsdf =
      values(picture_of_guide(InspectQuantity::guide_probability, BsdfGuideSettings{}, 0));
  EXPECT_EQ(bsdf, std::set<double>{0});
  EXPECT_EQ(values(picture_of_guide(InspectQuantity::guide_cells, BsdfGuideSettings{}, 0)),
            std::set<double>{0});
}

TEST(InspectGuide, ShowsWhatWasLearned) {
  SdTreeGuideSettings sd_tree;
  LearnedSkeletonGuideSettings skeleton;
  sd_tree.leaf_vertices = skeleton.leaf_vertices = 200;
  for (const GuideSettings& guide : {GuideSettings(sd_tree), GuideSettings(skeleton)}) {
    const auto probability = [&](int learn) {
      return picture_of_guide(InspectQuantity::guide_probability, guide, learn);
    };
    EXPECT_NE(probability(0), probability(3));
    EXPECT_NE(picture_of_guide(InspectQuantity::guide_density, guide, 0),
              picture_of_guide(InspectQuantity::guide_density, guide, 3));
    const auto cells = picture_of_guide(InspectQuantity::guide_cells, guide, 7);
    EXPECT_GT(values(cells).size(),
              values(picture_of_guide(InspectQuantity::guide_cells, guide, 0)).size())
        << "cells have been divided";
    EXPECT_EQ(cells, picture_of_guide(InspectQuantity::guide_cells, guide, 7, 1)) << "one thread";
  }
}

}  // namespace
}  // namespace lacuna
