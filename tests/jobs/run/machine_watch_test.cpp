#include "jobs/run/machine_watch.h"

#include <gtest/gtest.h>

namespace lacuna {
namespace {

TEST(MachineWatch, ReadsTheFirstLineOfProcStat) {
  // user nice system idle iowait irq softirq steal guest guest_nice (proc(5)); guests count once.
  const auto t = parse_processor_ticks("cpu  100 20 30 400 50 6 7 80 9 1\n");
  ASSERT_TRUE(t);
  EXPECT_EQ(t->all, 693);
  EXPECT_EQ(t->idle, 450);
  EXPECT_EQ(t->stolen, 80);
  EXPECT_FALSE(parse_processor_ticks("intr 1 2 3 4 5 6 7 8"));
  EXPECT_FALSE(parse_processor_ticks("cpu 1 2 3"));
  EXPECT_FALSE(parse_processor_ticks("cpu 1 2 3 4 x 6 7 8"));
}

TEST(MachineWatch, SaysNothingOfAnInstant) { EXPECT_FALSE(MachineWatch().disturbance()); }

}  // namespace
}  // namespace lacuna
