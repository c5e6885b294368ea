#include <gtest/gtest.h>

#include "jobs/spec/limits.h"
#include "jobs/spec/nearest.h"

namespace lacuna {
namespace {

const std::vector<std::string_view> known{"scene", "camera", "resolution", "seed", "threads"};

TEST(Nearest, FindsWhatWasProbablyMeant) {
  EXPECT_EQ(nearest("scenes", known), "scene");
  EXPECT_EQ(nearest("Camera", known), "camera");
  EXPECT_EQ(nearest("resoultion", known), "resolution");
  EXPECT_EQ(nearest("res_olutoin", known), "resolution");
  EXPECT_EQ(nearest("sede", known), "seed");
  EXPECT_EQ(nearest("hreads", known), "threads");
}

TEST(Nearest, DoesNotGuessWildly) {
  EXPECT_EQ(nearest("", known), std::nullopt);
  EXPECT_EQ(nearest("x", known), std::nullopt);
  EXPECT_EQ(nearest("budget", known), std::nullopt);
  EXPECT_EQ(nearest(std::string(100000, 's'), known), std::nullopt);
  EXPECT_EQ(nearest("scene", {}), std::nullopt);
  EXPECT_EQ(nearest("b", {"a"}), std::nullopt);
}

TEST(Limits, OfIntegersIncludeThoseOfTheTypeAndOfExactDoubles) {
  EXPECT_EQ(limits_of<int>({}).max, 2147483647.0);
  EXPECT_EQ(limits_of<std::int64_t>({}).min, -max_exact_integer);
  EXPECT_EQ(limits_of<std::uint64_t>({}).min, 0.0);
  EXPECT_EQ(limits_of<int>({.doc = "", .min = -5, .max = 1e12}).min, -5.0);
  EXPECT_TRUE(limits_of<double>({}).allow(1e300));
}

}  // namespace
}  // namespace lacuna
