// {"as": "published"}: what a document leaves out has the papers' values.

#include "jobs/spec/published.h"

#include <gtest/gtest.h>

#include "expect_problems.h"
#include "jobs/spec/job_json.h"

namespace lacuna {
namespace {

JobSpec with(const std::string& rest) { return parse_job(R"({"scene": "a.glb", )" + rest + "}"); }

template <class T, class V>
const T& held(const V& variant) {
  return std::get<T>(variant);
}

const std::string guided = R"("guide": {"type": "skeleton", "strength": 16}})";

TEST(Published, HoldsForWhatIsLeftOutThereAndBelow) {
  const JobSpec plain = with(R"("integrator": {"type": "path", )" + guided);
  const JobSpec all = with(R"("as": "published", "integrator": {"type": "path", )" + guided);
  EXPECT_EQ(plain.sampler, Sampler::sobol);
  EXPECT_EQ(all.sampler, Sampler::independent);
  EXPECT_EQ(all.analysis.node_radius, NodeRadius::chessboard);
  const auto& path = held<PathSettings>(all.integrator);
  EXPECT_EQ(path.heuristic, Heuristic::balance);
  const auto& guide = held<SkeletonGuideSettings>(path.guide);
  EXPECT_EQ(guide.strength.value, 16);
  EXPECT_EQ(guide.probability.value, 0.5);
  EXPECT_EQ(guide.aim, ImportanceAim::mean);
  EXPECT_EQ(guide.roulette, GuidedRoulette::throughput);

  const JobSpec part =
      with(R"("integrator": {"type": "path", "as": "published", "heuristic": "power", )" + guided);
  EXPECT_EQ(part.sampler, Sampler::sobol);
  EXPECT_EQ(part.analysis, AnalysisSettings{});
  EXPECT_EQ(held<PathSettings>(part.integrator).heuristic, Heuristic::power);
  EXPECT_EQ(held<PathSettings>(part.integrator).guide, path.guide);
}

TEST(Published, MembersThatAreLeftOutWholeHaveItToo) {
  const auto connections =
      held<BdptSettings>(with(R"("integrator": {"type": "bdpt", "as": "published"})").integrator)
          .connections;
  EXPECT_EQ(held<PairedSettings>(connections).direct, DirectPoint::light_path);
  const auto resampled =
      held<BdptSettings>(
          with(R"("as": "published", "integrator": {"type": "bdpt", "connections": "skeleton"})")
              .integrator)
          .connections;
  EXPECT_EQ(held<SkeletonConnectionsSettings>(resampled).combination, Combination::max);
  EXPECT_EQ(held<SkeletonConnectionsSettings>(resampled).count_as, 0);
}

TEST(Published, IsUndoneFurtherBelow) {
  const JobSpec job = with(R"("as": "published", "analysis": {"as": "default"}, "integrator":
      {"type": "path", "as": "default", "guide": {"type": "sd_tree", "as": "published"}})");
  EXPECT_EQ(job.sampler, Sampler::independent);
  EXPECT_EQ(job.analysis, AnalysisSettings{});
  const auto& path = held<PathSettings>(job.integrator);
  EXPECT_EQ(path.heuristic, Heuristic::power);
  EXPECT_EQ(held<SdTreeGuideSettings>(path.guide).roulette, GuidedRoulette::throughput);
}

TEST(Published, IsWrittenOut) {
  const JobSpec job = with(R"("as": "published", "integrator": {"type": "many_lights",
      "visibility": "probabilistic"})");
  const std::string written = write_job(job);
  EXPECT_EQ(written.find("\"as\""), std::string::npos);
  EXPECT_EQ(parse_job(written), job);
}

TEST(Published, IsNoKeyWhereNothingIsPublished) {
  EXPECT_FALSE(PublishedFinder::has<Budget>());
  EXPECT_TRUE(PublishedFinder::has<JobSpec>());
  const auto problems = problems_of([] { with(R"("budget": {"as": "published"})"); });
  expect_one(problems, "/budget/as", {"unknown key \"as\""});
  expect_one(problems_of([] { with(R"("as": "printed")"); }), "/as",
             {"\"default\", \"published\""});
}

}  // namespace
}  // namespace lacuna
