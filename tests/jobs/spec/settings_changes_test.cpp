// What the suite of extremes makes its columns of: every alternative, flag and number of a table.
#include <gtest/gtest.h>

#include "tests/extremes/settings_changes.h"
#include "tests/jobs/spec/all_types.h"

namespace lacuna {
namespace {

using extremes::End;

/// What each change is called, and the settings that come of it.
template <class Visitor, class... Args>
std::vector<std::pair<std::string, AllTypes>> all_changes(Args... args) {
  std::vector<std::pair<std::string, AllTypes>> all;
  for (int i = 0;; ++i) {
    AllTypes settings;
    Visitor visitor(i, args...);
    describe(visitor, settings);
    if (visitor.made().empty()) return all;
    all.emplace_back(visitor.made(), settings);
  }
}

std::vector<std::string> names(const std::vector<std::pair<std::string, AllTypes>>& changes) {
  std::vector<std::string> all;
  for (const auto& [name, settings] : changes) {
    EXPECT_NE(settings, AllTypes{}) << name;
    all.push_back(name);
  }
  return all;
}

TEST(SettingsChanges, EveryOtherAlternative) {
  const auto changes = all_changes<extremes::OtherChoice>();
  EXPECT_EQ(names(changes), (std::vector<std::string>{" maybe_shape=box", " shape=box"}));
  EXPECT_EQ(changes[1].second.shape, (std::variant<Sphere, Box>(Box{})));
}

TEST(SettingsChanges, EveryOtherFlagAndNamedValue) {
  const auto changes = all_changes<extremes::OtherFlag>();
  EXPECT_EQ(names(changes), (std::vector<std::string>{" flag=true", " colour=red",
                                                      " maybe_colour=green", " found=auto"}));
  EXPECT_TRUE(changes[0].second.flag);
  EXPECT_EQ(changes[0].second.colour, Colour::green) << "one at a time";
  EXPECT_EQ(changes[2].second.maybe_colour, Colour::green);
}

TEST(SettingsChanges, EveryNumberThatHasThatEnd) {
  const auto least = all_changes<extremes::NumberAt>(End::lowest);
  const std::vector<std::string> expected{" small=-2147483648",
                                          " wide=-9007199254740991",
                                          " positive=0",
                                          " real=-1",
                                          " maybe=2",
                                          " maybe_sphere.radius=5e-324",
                                          " maybe_shape.radius=5e-324",
                                          " found=0",
                                          " pair=0",
                                          " pair=0",
                                          " nested.radius=5e-324",
                                          " shape.radius=5e-324"};
  EXPECT_EQ(names(least), expected);
  EXPECT_EQ(least[9].second.pair, (std::array<int, 2>{1, 0}));
  const auto above = all_changes<extremes::NumberAt>(End::above);
  EXPECT_EQ(above.back().first, " pair=10") << "nothing lies above what has no end";
}

}  // namespace
}  // namespace lacuna
