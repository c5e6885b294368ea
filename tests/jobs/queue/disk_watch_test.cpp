#include "jobs/queue/disk_watch.h"

#include <gtest/gtest.h>

namespace lacuna {
namespace {

constexpr std::uint64_t mb = 1'000'000;

TEST(DiskWatch, LooksAtBytesAndInodes) {
  EXPECT_EQ(shortage_of({100 * mb, 5000, 100'000}, 50 * mb, false), "");
  EXPECT_EQ(shortage_of({49 * mb, 5000, 100'000}, 50 * mb, false),
            "49 MB are free on the disk, the floor is 50 MB");
  EXPECT_EQ(shortage_of({100 * mb, 1000, 100'000}, 50 * mb, false),
            "1000 inodes are free on the disk, the floor is 1024");
  EXPECT_EQ(shortage_of({100 * mb, 9, 160}, 50 * mb, false),
            "9 inodes are free on the disk, the floor is 10");
}

TEST(DiskWatch, WantsATenthMoreBeforeThereIsRoomAgain) {
  EXPECT_NE(shortage_of({54 * mb, 5000, 100'000}, 50 * mb, true), "");
  EXPECT_EQ(shortage_of({55 * mb, 5000, 100'000}, 50 * mb, true), "");
  EXPECT_NE(shortage_of({100 * mb, 1100, 100'000}, 50 * mb, true), "");
  EXPECT_EQ(shortage_of({100 * mb, 1200, 100'000}, 50 * mb, true), "");
}

TEST(DiskWatch, InodesCountOnlyWhereThereIsANumberOfThem) {
  EXPECT_EQ(shortage_of({100 * mb, 0, 0}, 50 * mb, false), "") << "made as they are needed";
  EXPECT_EQ(shortage_of({0, 0, 100'000}, 0, false), "") << "any room is enough";
}

}  // namespace
}  // namespace lacuna
