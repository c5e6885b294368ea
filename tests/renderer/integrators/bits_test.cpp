// The bits of light tracing and of every choice of connections: whatever the threads, whatever
// power of two the scene is scaled by, and after a pause.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <span>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/transformed.h"

namespace lacuna {
namespace {

using test::own_scene;
using test::Session;

std::vector<test::Method> bidirectional(int max_depth) {
  std::vector<test::Method> all = test::connections(max_depth, 100);
  for (test::Method& m : all) {  // so that what was learned is used everywhere
    auto& connections = std::get<BdptSettings>(m.settings).connections;
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.roulette; }) s.roulette = 1;
        },
        connections);
  }
  all.push_back({"light", test::light_tracing(max_depth)});
  all.push_back({"light_towards_eye", test::light_towards_eye(max_depth)});
  all.push_back({"bdpt_towards_eye", test::joining_towards_eye(max_depth, PairedSettings{})});
  for (test::Method& m : test::guided(max_depth)) all.push_back(std::move(m));
  for (test::Method& m : test::metropolis(max_depth)) all.push_back(std::move(m));
  PathSettings sharing = test::path_tracing(max_depth);
  sharing.reuse = 16;
  all.push_back({"path_reuse", sharing});
  for (test::Method& m : test::many_lights(max_depth)) all.push_back(std::move(m));
  for (test::Method& m : test::approximate_lights(max_depth)) all.push_back(std::move(m));
  for (test::Method& m : test::merging(max_depth)) all.push_back(std::move(m));
  return all;
}

class BidirectionalBits : public testing::TestWithParam<test::Method> {};

TEST_P(BidirectionalBits, DoNotDependOnThreads) {
  for (const char* scene : {"ajar.glb", "many_lights.glb"}) {
    test::RenderSettings s{
        .integrator = GetParam().settings, .width = 70, .height = 45, .iterations = 3};
    s.threads = 1;
    const test::Rendering one = test::render(scene, s);
    s.threads = 64;  // more than there are cores
    const test::Rendering many = test::render(scene, s);
    EXPECT_EQ(one.film.mean(), many.film.mean()) << scene;
    EXPECT_EQ(one.film.variance_of_mean(), many.film.variance_of_mean()) << scene;
    EXPECT_EQ(one.counters.rays, many.counters.rays) << scene;
    EXPECT_EQ(one.counters.shadow_rays, many.counters.shadow_rays) << scene;
    EXPECT_EQ(one.counters.samples, many.counters.samples) << scene;
    EXPECT_GT(one.mean(), 0);
  }
}

struct ScaledScene {
  const char* name;
  bool sky;
};

// Scaling by a power of two moves exponents only.
void expect_same_under_scale(const test::Method& method, std::span<const ScaledScene> scenes) {
  for (const ScaledScene& lit : scenes) {
    test::RenderSettings s{
        .integrator = method.settings, .width = 24, .height = 20, .iterations = 3};
    if (lit.sky) s.environment = EnvironmentImage{own_scene("sky.hdr"), 1, 0.7F};
    const std::vector<double> expected =
        test::render(test::transformed(lit.name, 1, V3d(0)), s).film.mean();
    for (const double scale : {0x1p-14, 0x1p17}) {
      const test::Rendering r = test::render(test::transformed(lit.name, scale, V3d(0)), s);
      const std::vector<double> mean = r.film.mean();
      std::size_t different = 0;
      for (std::size_t i = 0; i < mean.size(); ++i) different += mean[i] != expected[i] ? 1 : 0;
      EXPECT_EQ(different, 0U) << lit.name << " at scale " << scale;
      EXPECT_EQ(r.counters.rejected, 0U);
    }
  }
}

TEST_P(BidirectionalBits, StayUnderScaleByPowersOfTwo) {
  expect_same_under_scale(
      GetParam(), std::array{ScaledScene{"cornell.glb", false}, ScaledScene{"open.glb", true}});
}

class LongBidirectionalBits : public testing::TestWithParam<test::Method> {};

TEST_P(LongBidirectionalBits, StayUnderScaleByPowersOfTwo) {
  expect_same_under_scale(GetParam(), std::array{ScaledScene{"many_lights.glb", false},
                                                 ScaledScene{"atrium.glb", false}});
}

test::RenderSettings paused_picture(const test::Method& method) {
  return {.integrator = method.settings, .width = 24, .height = 20};
}

TEST_P(BidirectionalBits, GoOnAfterAPause) {
  const auto start = [] {
    return std::make_unique<Session>(load_gltf(own_scene("ajar.glb")), paused_picture(GetParam()));
  };
  const auto straight = start();
  ByteWriter saved;
  std::vector<Image> expected;
  for (std::uint64_t i = 0; i < 7; ++i) {
    if (i == 4) straight->integrator().save(saved);
    expected.push_back(straight->iterate(i));
  }
  const auto resumed = start();
  ByteReader in(saved.bytes());
  resumed->integrator().load(in);
  EXPECT_TRUE(in.at_end());
  for (std::uint64_t i = 4; i < 7; ++i) {
    EXPECT_EQ(resumed->iterate(i).pixels, expected[i].pixels) << "iteration " << i;
  }
  // What was learned is of use: without it the pictures differ. The light that portals expect, and
  // a tree that has learned to be left alone, change no path of this small picture.
  const std::string& name = GetParam().name;
  if (name == "path_portals" || name.ends_with("learning_sd_tree")) return;
  const auto forgetful = start();
  EXPECT_EQ(forgetful->iterate(4).pixels != expected[4].pixels, !saved.bytes().empty());
}

TEST_P(BidirectionalBits, AreTheSameAfterAnIterationThatWasStopped) {
  const auto start = [] {
    return std::make_unique<Session>(load_gltf(own_scene("ajar.glb")), paused_picture(GetParam()));
  };
  const auto straight = start(), stopped = start();
  ByteWriter a, b;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const Image expected = straight->iterate(i);
    // Later and later, until the iteration gets through.
    for (int after = 0;; after += 1 + after / 8) {
      std::atomic<int> asked{0};
      try {
        const Image image = stopped->iterate(i, [&] { return ++asked > after; });
        EXPECT_EQ(image.pixels, expected.pixels) << "iteration " << i;
        break;
      } catch (const IterationStopped&) {
      }
      ASSERT_LT(after, 100000);
    }
  }
  straight->integrator().save(a);
  stopped->integrator().save(b);
  EXPECT_EQ(a.bytes(), b.bytes());
}

INSTANTIATE_TEST_SUITE_P(All, BidirectionalBits, testing::ValuesIn(bidirectional(4)),
                         [](const auto& m) { return m.param.name; });
INSTANTIATE_TEST_SUITE_P(Long, LongBidirectionalBits, testing::ValuesIn(bidirectional(4)),
                         [](const auto& m) { return m.param.name; });

TEST(NodeCounts, OfAnotherSkeletonAreRefused) {
  const test::Method skeleton{"",
                              test::joining(3, test::resampled<SkeletonConnectionsSettings>(16))};
  Session ajar(load_gltf(own_scene("ajar.glb")), paused_picture(skeleton));
  Session cornell(load_gltf(own_scene("cornell.glb")), paused_picture(skeleton));
  ajar.iterate(0);
  ByteWriter saved;
  ajar.integrator().save(saved);
  ByteReader in(saved.bytes());
  EXPECT_THROW(cornell.integrator().load(in), std::runtime_error);
  ByteReader cut(std::string_view(saved.bytes()).substr(0, saved.bytes().size() - 1));
  EXPECT_THROW(ajar.integrator().load(cut), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
