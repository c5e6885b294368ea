#include <gtest/gtest.h>

#include "jobs/store/job_folder.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

TEST(UtcText, RoundsDownOnBothSidesOf1970) {
  using std::chrono::milliseconds;
  const auto text = [](std::int64_t ms) {
    return utc_text(std::chrono::system_clock::time_point(milliseconds(ms)));
  };
  EXPECT_EQ(text(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(text(1'001), "1970-01-01T00:00:01.001Z");
  EXPECT_EQ(text(-1), "1969-12-31T23:59:59.999Z");
  EXPECT_EQ(text(-1'000), "1969-12-31T23:59:59.000Z");
  EXPECT_EQ(text(-1'001), "1969-12-31T23:59:58.999Z");
}

TEST(JobIds, HaveTheFormThatIsLookedUp) {
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = new_job_id();
    EXPECT_TRUE(is_job_id(id)) << id;
    ids.insert(id);
  }
  EXPECT_GE(ids.size(), 999u);  // 36^6 of them a second
}

TEST(JobIds, NothingElseIsLookedUp) {
  ASSERT_TRUE(is_job_id("20260131-235959-k3x9qa"));
  for (const std::string& s :
       {std::string(), std::string("."), std::string(".."), std::string("20260131-235959-k3x9q"),
        std::string("20260131-235959-k3x9qab"), std::string("20260131-235959-k3x9qA"),
        std::string("20260131-235959-k3x9q/"), std::string("20260131-235959-k3x9q."),
        std::string("20260131_235959-k3x9qa"), std::string("2026013a-235959-k3x9qa"),
        std::string("20260131-235959-k3x9q\0", 22), std::string("../../../../../etc/pass"),
        std::string(" 0260131-235959-k3x9qa")}) {
    EXPECT_FALSE(is_job_id(s)) << s;
  }
}

TEST(JobIds, OfRunsFollowFromTheSweeps) {
  const std::string sweep = "20260131-235959-k3x9qa";
  EXPECT_EQ(run_job_id(sweep, 0), "20260131-235959-k3x9qb");
  EXPECT_EQ(run_job_id(sweep, 24), "20260131-235959-k3x9qz");
  EXPECT_EQ(run_job_id(sweep, 25), "20260131-235959-k3x9r0");
  EXPECT_EQ(run_job_id("20260131-235959-zzzzzy", 0), "20260131-235959-zzzzzz");
  EXPECT_EQ(run_job_id("20260131-235959-zzzzzy", 1), "20260131-235959-000000");
  for (const std::string& id : {sweep, std::string("20260131-235959-zzzzzy"), new_job_id()}) {
    std::string before;
    for (const std::size_t index : {0, 1, 35, 36, 999, 99'999}) {
      const std::string run = run_job_id(id, index);
      EXPECT_TRUE(is_job_id(run)) << run;
      EXPECT_EQ(run_index(id, run), index);
      EXPECT_NE(run, before);
      before = run;
    }
    EXPECT_GT(run_index(id, id).value(), std::size_t{1} << 30U) << "no run is the sweep itself";
  }
  EXPECT_EQ(run_index(sweep, "20260131-235958-k3x9qb"), std::nullopt) << "another second";
  EXPECT_EQ(run_index(sweep, "20260131-235959-k3x9qB"), std::nullopt) << "no id";
}

TEST(JobIds, NowIsIso8601WithMilliseconds) {
  std::string shape = utc_now();
  for (char& c : shape) {
    if (c >= '0' && c <= '9') c = 'd';
  }
  EXPECT_EQ(shape, "dddd-dd-ddTdd:dd:dd.dddZ");
  const std::string before = utc_now(), after = utc_now();
  EXPECT_LE(before, after);
}

TEST(JobIds, JobsAreListedOldestFirstAndNothingElseIs) {
  const TemporaryFolder tmp;
  EXPECT_TRUE(list_jobs(tmp / "missing").empty());
  JobSpec spec;
  spec.scene = "a.glb";
  const std::vector<std::string> ids{"20251231-235959-zzzzzz", "20260101-000000-aaaaaa",
                                     "20260131-120000-mmmmmm"};
  for (const int i : {2, 0, 1}) JobFolder::create(tmp / ids[std::size_t(i)], spec);
  JobFolder::create(tmp / "not-an-id", spec);
  std::filesystem::create_directory(tmp / "20260131-120000-nojobs");
  put_file(tmp / "20260131-120000-a0file", "x");
  std::filesystem::create_directory_symlink(ids[0], tmp / "20260131-120000-a0link");
  std::vector<std::string> listed;
  for (const JobFolder& job : list_jobs(tmp.path())) listed.push_back(job.id());
  EXPECT_EQ(listed, ids);
}

}  // namespace
}  // namespace lacuna
