#include "jobs/run/obstacle.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/storage/passing_error.h"

namespace lacuna {
namespace {

std::system_error error(int number) { return {number, std::generic_category(), "cannot write x"}; }

TEST(Obstacle, AWriteThatAnotherTimeMayBring) {
  for (const int number : {ENOSPC, EDQUOT, EFBIG, EROFS, EIO, EACCES}) {
    EXPECT_EQ(obstacle_of(error(number)), Obstacle::storage) << number;
  }
  for (const int number : {ENOENT, EISDIR, EINVAL, ELOOP}) {
    EXPECT_EQ(obstacle_of(error(number)), Obstacle::none) << number;
  }
}

TEST(Obstacle, AnInputThatAnotherTimeMayBring) {
  for (const int number : {EIO, ENOENT, ESTALE}) {
    EXPECT_EQ(obstacle_of(InputUnreadable(number, "a.glb")), Obstacle::input) << number;
    EXPECT_TRUE(may_pass(InputUnreadable(number, "a.glb"))) << number;
  }
  EXPECT_EQ(obstacle_of(InputUnreadable(ENOMEM, "a.glb")), Obstacle::memory);
}

TEST(Obstacle, WantOfMemoryHoweverItIsTold) {
  EXPECT_EQ(obstacle_of(std::bad_alloc()), Obstacle::memory);
  EXPECT_EQ(obstacle_of(std::bad_array_new_length()), Obstacle::memory);
  EXPECT_EQ(obstacle_of(error(ENOMEM)), Obstacle::memory);
  EXPECT_EQ(reason_of(std::bad_alloc()), "out of memory");
}

TEST(Obstacle, AllElseWouldFailAgain) {
  EXPECT_EQ(obstacle_of(std::runtime_error("no")), Obstacle::none);
  EXPECT_EQ(reason_of(std::runtime_error("no")), "no");
}

}  // namespace
}  // namespace lacuna
