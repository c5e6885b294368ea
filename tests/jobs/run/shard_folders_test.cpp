#include "jobs/run/shard_folders.h"

#include <gtest/gtest.h>

#include <system_error>

#include "jobs/spec/problems.h"
#include "tests/failing_files.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

TEST(ShardFolders, AShardThatCannotBeReadNowIsNotRefused) {
  const TemporaryFolder tmp;
  JobSpec spec;
  spec.scene = "a.glb";
  spec.shards = 2;
  spec.shard = 1;
  const JobFolder folder = JobFolder::create(tmp / "shard", spec);
  folder.write_state({});
  for (const char* name : {"job.json", "outcome.json"}) {
    const FailingFiles failing(FileCall::open, name);
    EXPECT_THROW(read_shards({folder.dir()}), std::system_error) << name;
  }
  EXPECT_THROW(read_shards({folder.dir()}), BadJob) << "it is not done";
}

}  // namespace
}  // namespace lacuna
