#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "expect_problems.h"
#include "jobs/spec/job_json.h"
#include "random_settings.h"
#include "table_keys.h"

namespace lacuna {
namespace {

std::vector<Problem> job_problems(const std::string& json) {
  return problems_of([&] { parse_job(json); });
}

TEST(Job, ASceneIsEnough) {
  JobSpec expected;
  expected.scene = "a.glb";
  expected.budget.seconds = Budget::default_seconds;
  EXPECT_EQ(parse_job(R"({"scene": "a.glb"})"), expected);
  EXPECT_EQ(parse_job(R"({"scene": "a.glb", "budget": {}, "environment": null})"), expected);
}

TEST(Job, TheDefaultBudgetIsOnlyForJobsWithoutAnyLimit) {
  for (const char* limit : {R"("iterations": 3)", R"("cpu_seconds": 3)",
                            R"("error": {"metric": "est_rmse", "target": 0.1})"}) {
    const JobSpec spec = parse_job(R"({"scene": "a.glb", "budget": {)" + std::string(limit) + "}}");
    EXPECT_EQ(spec.budget.seconds, std::nullopt) << limit;
  }
}

TEST(Job, AMissingSceneIsTold) {
  expect_one(job_problems("{}"), "/scene", {"missing; required: glTF or GLB file"});
  expect_one(job_problems("[]"), "", {"found a list of 0; allowed: an object"});
  expect_one(job_problems("7"), "", {"found number 7"});
}

TEST(Job, AnErrorTargetNeedsAReferenceUnlessItIsAnEstimate) {
  const auto job = [](const std::string& metric, const std::string& more) {
    return R"({"scene": "a", "budget": {"error": {"target": 1, "metric": ")" + metric + "\"}}" +
           more + "}";
  };
  EXPECT_TRUE(job_problems(job("est_rmse", "")).empty());
  EXPECT_TRUE(job_problems(job("mae", R"(, "reference": "door")")).empty());
  expect_one(job_problems(job("mae", "")), "/budget/error/metric",
             {"found \"mae\"", "without \"reference\"", "\"est_rmse\""});
  // A reference that is there but wrong is one problem, not two.
  expect_one(job_problems(job("mae", R"(, "reference": 1)")), "/reference", {"found number 1"});
}

TEST(Job, ACameraIsANameOrAPlaceOfItsOwn) {
  const auto job = [](const std::string& camera) {
    return R"({"scene": "a", "camera": )" + camera + "}";
  };
  EXPECT_EQ(parse_job(job(R"("front")")).camera.name, "front");
  const std::string view = R"("position": [1, 2, 3], "target": [1, 2, 2])";
  const auto own = parse_job(job("{" + view + R"(, "fov": 60})")).camera.object;
  ASSERT_TRUE(own);
  EXPECT_EQ(own->position[2], 3);
  EXPECT_EQ(own->fov, 60);
  expect_one(job_problems(job("7")), "/camera", {"found number 7", "a name, or an object"});
  expect_one(job_problems(job(R"({"position": [1, 2, 3]})")), "/camera/target", {"required"});
  expect_one(job_problems(job("{" + view + R"(, "fov": 180})")), "/camera/fov", {"179"});
  expect_one(job_problems(job("{" + view + R"(, "name": "x"})")), "/camera/name", {"unknown"});
  expect_one(
      job_problems(job(R"({"position": [1e9, 0, 0], "target": [1000000000.0000002, 0, 0]})")),
      "/camera/target", {"1000000000.0000002", "another point"});
  expect_one(job_problems(job(R"({"position": [1, 2, 3], "target": [1, 2, 3]})")), "/camera/target",
             {"the camera's position"});
  const auto with = [&](const std::string& more) { return job("{" + view + ", " + more + "}"); };
  EXPECT_TRUE(job_problems(with(R"("aperture": 0.1, "focus": 2, "blades": 6)")).empty());
  EXPECT_TRUE(job_problems(with(R"("type": "orthographic", "height": 3)")).empty());
  expect_one(job_problems(with(R"("type": "panorama", "aperture": 0.1)")), "/camera/aperture",
             {"found 0.1", "allowed: type \"perspective\""});
  expect_one(job_problems(with(R"("type": "orthographic", "fov": 20)")), "/camera/fov",
             {"a camera that does not use it"});
  expect_one(job_problems(with(R"("focus": 2)")), "/camera/focus", {"an aperture above 0"});
  expect_one(job_problems(with(R"("aperture": 1, "blades": 2)")), "/camera/blades", {"3 to 64"});
  for (const char* up : {"[0, 0, 0]", "[0, 0, -2]"})
    expect_one(job_problems(job("{" + view + R"(, "up": )" + up + "}")), "/camera/up",
               {"along the view"});
}

TEST(Job, CandidatesHaveThePathLengthsOfAutoAndNoBias) {
  const auto with = [](const std::string& candidates) {
    return R"({"scene": "a", "integrator": {"type": "auto", "max_depth": 5, "candidates": [)" +
           candidates + "]}}";
  };
  EXPECT_NO_THROW(parse_job(with(R"("path", {"type": "bdpt", "max_depth": 5}, "metropolis")")));
  expect_one(job_problems(with(R"("path", {"type": "bdpt", "max_depth": 7})")),
             "/integrator/candidates/1", {"max_depth 7", "allowed: those"});
  expect_one(job_problems(with(R"({"type": "many_lights", "compensation": false})")),
             "/integrator/candidates/0", {"biased", "\"unbiased\""});
  const auto allowing = [](const std::string& what, const std::string& candidates) {
    return R"({"scene": "a", "integrator": {"type": "auto", "allow": ")" + what +
           R"(", "candidates": [)" + candidates + "]}}";
  };
  EXPECT_TRUE(job_problems(allowing("consistent", R"("sppm", "path")")).empty());
  EXPECT_TRUE(job_problems(allowing("biased", R"("photon_map", "path")")).empty());
  expect_one(job_problems(allowing("consistent", R"("photon_map", "path")")),
             "/integrator/candidates/0", {"\"consistent\""});
  expect_one(job_problems(allowing("biased", R"("photon_map", "sppm")")), "/integrator/candidates",
             {"found no unbiased one"});
  expect_one(job_problems(with(R"("inspect")")), "/integrator/candidates/0", {"\"path\""});
}

// Stored jobs have every key of the version that wrote them.
TEST(Job, KeysOfEarlierVersionsMeanNothing) {
  const auto job = [](const std::string& integrator) {
    return R"({"scene": "a", "integrator": )" + integrator + "}";
  };
  EXPECT_EQ(parse_job(job(R"({"type": "path", "sampling": "uniform"})")),
            parse_job(job(R"("path")")));
  EXPECT_EQ(parse_job(job(R"({"type": "auto", "regions": true, "sampling": "adaptive",
                              "clock": "cpu_seconds", "remember": true})")),
            parse_job(job(R"("auto")")));
  expect_one(job_problems(job(R"({"type": "path", "sampling": "adaptive"})")),
             "/integrator/sampling", {"earlier version", "allowed: \"uniform\""});
  EXPECT_EQ(parse_job(job(R"({"type": "path", "roulette": "throughput"})")),
            parse_job(job(R"("path")")));
  expect_one(job_problems(job(R"({"type": "path", "roulette": "efficiency"})")),
             "/integrator/roulette", {"earlier version", "allowed: \"throughput\""});
  expect_one(job_problems(job(R"({"type": "auto", "clock": "rays"})")), "/integrator/clock",
             {"earlier version", "allowed: \"cpu_seconds\""});
}

TEST(Job, ShardsHaveOneMethod) {
  const std::string job = R"({"scene": "a", "shards": 2, "integrator": )";
  EXPECT_NO_THROW(parse_job(job + R"("path"})"));
  expect_one(job_problems(job + R"("auto"})"), "/shards", {"different methods", "lacuna advise"});
}

TEST(Job, SettingsThatDoNotGoTogetherAreNamed) {
  const auto path = [](const std::string& more) {
    return R"({"scene": "a", "integrator": {"type": "path", "reuse": 16)" + more + "}}";
  };
  EXPECT_NO_THROW(parse_job(path("")));
  EXPECT_NO_THROW(parse_job(path(R"(, "roulette_depth": 2)")));
  EXPECT_NO_THROW(parse_job(path(R"(, "guide": "skeleton")")));
  expect_one(job_problems(path(R"(, "roulette_depth": 1)")), "/integrator",
             {"roulette_depth 2 or more"});
  const std::string race =
      R"({"scene": "a", "integrator": {"type": "auto", "roulette_depth": 1, "candidates": [)";
  expect_one(job_problems(race + R"({"type": "path", "reuse": 2}]}})"), "/integrator/candidates/0",
             {"roulette_depth 2 or more", "reuse 1"});
}

TEST(Job, LayersComeOnce) {
  expect_one(job_problems(R"({"scene": "a", "layers": ["albedo", "depth", "albedo"]})"),
             "/layers/2", {"\"albedo\" again", "each layer once"});
  expect_one(job_problems(R"({"scene": "a", "layers": ["variance", "x"]})"), "/layers/1",
             {"string \"x\""});
}

TEST(Job, ACropLiesWithinTheLargerPicture) {
  const auto job = [](const std::string& crop) {
    return R"({"scene": "a", "resolution": [64, 32], "crop": )" + crop + "}";
  };
  EXPECT_TRUE(job_problems(job(R"({"of": [512, 32], "from": [448, 0]})")).empty());
  EXPECT_TRUE(job_problems(job(R"({"of": [64, 32]})")).empty());
  expect_one(job_problems(job(R"({"of": [512, 512], "from": [449, 0]})")), "/crop/of/0",
             {"found 512", "begins with 449 and has 64", "513 or more"});
  expect_one(job_problems(job(R"({"from": [0, 0]})")), "/crop/of", {"required"});
}

TEST(Job, NestedPointersNameThePlace) {
  expect_one(job_problems(R"({"scene": "a", "resolution": [1, 0]})"), "/resolution/1",
             {"found number 0; allowed: an integer from 1 to 16384 pixels"});
  expect_one(
      job_problems(R"({"scene": "a", "integrator": {"type": "path", "guide": {"type": "bdsf"}}})"),
      "/integrator/guide/type", {"string \"bdsf\"", "did you mean \"bsdf\"?"});
}

TEST(Job, LimitsOfTheDocument) {
  std::string deep = R"({"scene": "a", "label": )" + std::string(max_json_depth, '[') + "}";
  const auto found = job_problems(deep);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("too deep"), std::string::npos);
  const std::string job = R"({"scene": "a"})";
  EXPECT_TRUE(job_problems(job + std::string(max_job_bytes - job.size(), ' ')).empty());
  expect_one(job_problems(job + std::string(max_job_bytes - job.size() + 1, ' ')), "", {"bytes"});
}

TEST(Job, AShardIsOneOfThoseThatThereAre) {
  EXPECT_TRUE(job_problems(R"({"scene": "a", "shards": 8, "shard": 8})").empty());
  EXPECT_TRUE(job_problems(R"({"scene": "a", "shards": 8})").empty());
  expect_one(job_problems(R"({"scene": "a", "shards": 8, "shard": 9})"), "/shard",
             {"found 9", "0 to 8"});
  expect_one(job_problems(R"({"scene": "a", "shard": 2})"), "/shard", {"found 2", "0 to 1"});
}

TEST(Job, WhatIsWrittenReadsBackEqual) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const JobSpec spec = random_job(seed);
    const std::string text = write_job(spec);
    try {
      ASSERT_EQ(parse_job(text), spec) << text;
    } catch (const BadJob& e) {
      FAIL() << e.what() << '\n' << text;
    }
  }
}

TEST(Job, IsWrittenWithEveryKeyInTheOrderOfTheTable) {
  JobSpec spec;
  spec.label.push_back('\xff');  // cannot be written as it is
  const std::string text = write_job(spec);
  std::size_t last = 0;
  for (const std::string& name : keys_of(spec)) {
    const std::size_t at = text.find("\n  \"" + name + "\": ");
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_TRUE(last < at || last == 0) << name;
    last = at;
  }
  EXPECT_NE(text.find("\"label\": \"\xef\xbf\xbd\""), std::string::npos);
}

TEST(Job, EveryExampleIsAJob) {
  const std::filesystem::path examples = std::filesystem::path(LACUNA_SOURCE_DIR) / "jobs/examples";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(examples)) {
    if (entry.path().extension() != ".json" || entry.path().stem() == "sweep") continue;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    EXPECT_NO_THROW(parse_job(text.str())) << entry.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(BadJob, TellsEveryProblem) {
  const BadJob e({{"/a", "one"}, {"", "two"}});
  EXPECT_STREQ(e.what(), "/a: one\ntwo");
}

/// Bytes near a valid job: parse_job returns or throws BadJob, nothing else.
TEST(Job, SurvivesDamagedBytes) {
  std::mt19937_64 random(20260131);
  static constexpr std::string_view pieces[] = {"{",  "}",    "[",    "]",    ",",        ":",
                                                "\"", "1e9",  "-",    "null", "\"type\"", "\\u0000",
                                                "\\", "\xff", "\xc3", "NaN",  "1e999",    "\n"};
  int accepted = 0, refused = 0;
  for (int i = 0; i < 6000; ++i) {
    std::string text = write_job(random_job(random()));
    for (auto edits = 1 + random() % 4; edits > 0; --edits) {
      const std::size_t at = random() % text.size();
      switch (random() % 5) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, 1 + random() % 20);
          break;
        case 2:
          text.insert(at, pieces[random() % std::size(pieces)]);
          break;
        case 3:
          text.insert(at, text.substr(random() % text.size(), random() % 60));
          break;
        default:
          text[at] = static_cast<char>('0' + random() % 10);
      }
      if (text.empty()) text.push_back('{');
    }
    try {
      parse_job(text);
      ++accepted;
    } catch (const BadJob& e) {
      ASSERT_FALSE(e.problems().empty());
      ++refused;
    }
  }
  EXPECT_GT(accepted, 100);  // the damage is small enough to reach past the parser
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace lacuna
