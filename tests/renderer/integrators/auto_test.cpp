// The integrator that chooses among others: its pictures are right whatever it chooses.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "analysis/space/memory_limit.h"
#include "renderer/integrators/candidates.h"
#include "renderer/race/record.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/render.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/path/scenes.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

using test::own_scene;
using test::PathScene;
using test::RenderSettings;
using test::Session;

AutoSettings choosing_among(int max_depth, std::vector<CandidateSettings> candidates) {
  AutoSettings s = test::choosing(max_depth);
  s.candidates = std::move(candidates);
  return s;
}

RenderSettings picture(const IntegratorSettings& integrator, int iterations) {
  return {.integrator = integrator, .width = 20, .height = 12, .iterations = iterations};
}

TEST(LongAuto, AgreesWithBidirectionalPathTracing) {
  struct Row {
    PathScene scene;
    int max_depth;
    int iterations;
    double useful;
  };
  for (const Row& row : {Row{{"cornell"}, 4, 150, 0.02}, Row{{"ajar"}, 4, 150, 0.2},
                         Row{{"open", true}, 4, 200, 0.1}, Row{{"many_lights"}, 4, 120, 0.07}}) {
    SCOPED_TRACE(row.scene);
    // Many lights give path tracing a tail that no test of means allows for.
    const IntegratorSettings bidirectional = test::joining(row.max_depth, PairedSettings{});
    RenderSettings expected = picture(bidirectional, 4 * row.iterations);
    RenderSettings found = picture(test::choosing(row.max_depth), row.iterations);
    expected.environment = found.environment = environment(row.scene);
    expected.seed = 2;
    test::expect_same_picture(test::render(load(row.scene), found),
                              test::render(load(row.scene), expected), row.useful);
  }
}

// A race may render smaller pictures than candidates were prepared for.
TEST(Auto, CandidatesRenderSmallerPictures) {
  constexpr int max_depth = 4;
  const auto small = [](const IntegratorSettings& integrator, int iterations) {
    return RenderSettings{.integrator = integrator,
                          .width = 58,
                          .height = 34,
                          .reduction = 3,
                          .iterations = iterations};
  };
  RenderSettings plain = small(test::path_tracing(max_depth), 400);
  plain.seed = 2;
  const auto expected = test::render("cornell.glb", plain);
  for (const IntegratorSettings& c : candidates(test::choosing(max_depth))) {
    SCOPED_TRACE(candidate_name(c));
    test::expect_same_picture(test::render("cornell.glb", small(c, 60)), expected, 0.05);
  }
}

// A method with a heavy tail looks good as long as its rare bright paths are missing: it is chosen
// while its pictures are too dark. No such picture may be shown for that reason.
TEST(Auto, ItsChoiceDoesNotDarkenThePicture) {
  constexpr int max_depth = 4;
  statistics::Moments found, expected;
  int chosen = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    // Path tracing with and without emitters sampled: the second is right only by rare hits.
    PathSettings rare;
    rare.next_event_estimation = false;
    AutoSettings s = choosing_among(max_depth, {PathSettings{}, rare});
    RenderSettings r{.integrator = s, .width = 6, .height = 4, .iterations = 6};
    r.seed = seed;
    Session session(load_gltf(own_scene("cornell.glb")), r);
    double sum = 0;
    for (std::uint64_t i = 0; i < 6; ++i) {
      for (const Rgb& c : session.iterate(i).pixels) sum += double(c.x) + c.y + c.z;
    }
    found.add(sum / 6);
    const RaceRecord* race = session.integrator().race();
    ASSERT_NE(race, nullptr);
    chosen += race->candidates[1].share > 0 ? 1 : 0;
  }
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    RenderSettings r{.integrator = test::path_tracing(max_depth), .width = 6, .height = 4};
    r.seed = 1000 + seed;
    Session session(load_gltf(own_scene("cornell.glb")), r);
    double sum = 0;
    for (std::uint64_t i = 0; i < 40; ++i) {
      for (const Rgb& c : session.iterate(i).pixels) sum += double(c.x) + c.y + c.z;
    }
    expected.add(sum / 40);
  }
  EXPECT_GT(statistics::t_test(found, expected), 1e-3)
      << found.mean() << " +- " << found.standard_error() << ", " << expected.mean() << " +- "
      << expected.standard_error();
  EXPECT_LT(found.standard_error(), 0.015 * found.mean());
  EXPECT_GT(chosen, 100) << "without a choice there is nothing to see";
}

PathSettings adaptive(int max_depth) {
  PathSettings s = test::path_tracing(max_depth);
  s.sampling = Sampling::adaptive;
  return s;
}

// Where many samples are taken follows from samples that are not those.
TEST(LongAuto, AdaptiveSamplingIsRight) {
  for (const char* scene : {"cornell", "ajar"}) {
    SCOPED_TRACE(scene);
    RenderSettings expected = picture(test::path_tracing(4), 1600);
    RenderSettings found = picture(adaptive(4), 200);
    expected.width = found.width = 40;  // more than one block
    expected.height = found.height = 24;
    expected.seed = 2;
    test::expect_same_picture(test::render(load(PathScene{scene}), found),
                              test::render(load(PathScene{scene}), expected), 0.2);
  }
}

TEST(Auto, AdaptiveSamplingHasBitsAndState) {
  RenderSettings s = picture(adaptive(4), 12);
  s.width = 64;
  s.height = 48;
  const auto start = [&](int threads) {
    RenderSettings on = s;
    on.threads = threads;
    return std::make_unique<Session>(load_gltf(own_scene("ajar.glb")), on);
  };
  const auto straight = start(1), parallel = start(3);
  std::vector<Image> expected;
  for (std::uint64_t i = 0; i < 12; ++i) expected.push_back(straight->iterate(i));
  for (std::uint64_t i = 0; i < 12; ++i) EXPECT_EQ(parallel->iterate(i).pixels, expected[i].pixels);
  const RaceRecord* race = straight->integrator().race();
  ASSERT_NE(race, nullptr);
  EXPECT_FALSE(race->samples.empty()) << "the door shows more noise in some blocks";
  const auto stopped = start(2);
  for (std::uint64_t i = 0; i < 7; ++i) stopped->iterate(i);
  ByteWriter saved;
  stopped->integrator().save(saved);
  const auto resumed = start(2);
  ByteReader in(saved.bytes());
  resumed->integrator().load(in);
  for (std::uint64_t i = 7; i < 12; ++i) EXPECT_EQ(resumed->iterate(i).pixels, expected[i].pixels);
}

TEST(Auto, OneCandidateIsRenderedAsItIs) {
  RenderSettings s = picture(choosing_among(4, {BdptSettings{}}), 8);
  Session session(load_gltf(own_scene("cornell.glb")), s);
  for (std::uint64_t i = 0; i < 8; ++i) session.iterate(i);
  const RaceRecord* race = session.integrator().race();
  ASSERT_NE(race, nullptr);
  EXPECT_EQ(race->spent, 0);
  EXPECT_EQ(race->candidates[0].iterations, 8U);
}

TEST(LongAuto, WhatFindsNoMemoryLeaves) {
  ImportanceCacheSettings records;
  records.light_paths = 1 << 20;
  records.record_density = 0.1;
  BdptSettings large;
  large.connections = records;
  RenderSettings s = picture(choosing_among(4, {large, PathSettings{}}), 4);
  s.width = s.height = 256;
  Session session(load_gltf(own_scene("cornell.glb")), s);
  EXPECT_FALSE(is_black(session.iterate(0).pixels[256 * 200 + 128]));
  const RaceRecord* race = session.integrator().race();
  EXPECT_FALSE(race->candidates[0].racing);
  EXPECT_NE(race->candidates[0].reason.find("MiB"), std::string::npos)
      << race->candidates[0].reason;
  EXPECT_GT(race->candidates[1].share, 0);

  s.integrator = choosing_among(4, {large});
  Session alone(load_gltf(own_scene("cornell.glb")), s);
  EXPECT_THROW(alone.iterate(0), MemoryLimitError);
}

TEST(Auto, DoesNotRaceInTheDark) {
  SceneData data = load_gltf(own_scene("cornell.glb"));
  for (auto& m : data.materials) m.emission = Rgb(0, 0, 0);
  Session session(std::move(data), picture(choosing_among(4, {}), 4));
  for (const Rgb& c : session.iterate(0).pixels) EXPECT_TRUE(is_black(c));
  const RaceRecord* race = session.integrator().race();
  EXPECT_EQ(race->spent, 0);
  EXPECT_EQ(race->candidates[1].reason, "the scene has no light");
}

// Each shard of a job holds a race of its own, at its first iteration. Were its numbers those of
// another's, the merged picture would have the noise of one.
TEST(Auto, ShardsDoNotShareNumbers) {
  const RenderSettings s = picture(test::choosing(4), 3);
  Session first(load_gltf(own_scene("cornell.glb")), s),
      second(load_gltf(own_scene("cornell.glb")), s);
  const Image a = first.iterate(0), b = second.iterate(2);
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) same += a.pixels[i] == b.pixels[i] ? 1 : 0;
  EXPECT_LT(same, a.pixels.size() / 2) << "nearly half show the panel or nothing";
}

// What was saved by others is refused, whoever races by default in this version.
TEST(Auto, GoesOnWithNoOtherCandidates) {
  const auto session = [](std::vector<CandidateSettings> who) {
    return Session(test::load({"cornell"}), picture(choosing_among(4, std::move(who)), 2));
  };
  Session first = session({PathSettings{}, BdptSettings{}});
  first.iterate(0);
  ByteWriter saved;
  first.integrator().save(saved);
  Session other = session({PathSettings{}, MetropolisSettings{}});
  ByteReader in(saved.bytes());
  try {
    other.integrator().load(in);
    FAIL() << "loaded";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("\"bdpt\" in place of \"metropolis"), std::string::npos)
        << e.what();
  }
}

// The race goes on where it was stopped, in another process, too.
TEST(Auto, GoesOnInTheMiddleOfTheRace) {
  const RenderSettings s = picture(test::choosing(4), 3);
  const auto start = [&] { return std::make_unique<Session>(load_gltf(own_scene("ajar.glb")), s); };
  const auto straight = start();
  std::vector<Image> expected;
  for (std::uint64_t i = 0; i < 3; ++i) expected.push_back(straight->iterate(i));
  int stops = 0;
  for (const int after : {1, 3, 6, 12, 24, 48}) {
    const auto stopped = start();
    std::uint64_t next = 0;
    try {
      std::atomic<int> asked{0};
      for (; next < 3; ++next) stopped->iterate(next, [&] { return ++asked > after; });
    } catch (const IterationStopped&) {
      ++stops;
    }
    ByteWriter saved;
    stopped->integrator().save(saved);
    const auto resumed = start();
    ByteReader in(saved.bytes());
    resumed->integrator().load(in);
    EXPECT_TRUE(in.at_end());
    for (; next < 3; ++next) EXPECT_EQ(resumed->iterate(next).pixels, expected[next].pixels);
  }
  EXPECT_GE(stops, 3);
}

}  // namespace
}  // namespace lacuna
