#include <gtest/gtest.h>

#include <random>

#include "analysis/space/squared_lines.h"

namespace lacuna {
namespace {

TEST(SquaredLines, BothWaysGiveTheLeastOverAllPositions) {
  std::mt19937 rng(21);
  for (const int length : {1, 2, 3, 17, 60, 500}) {
    for (const std::uint32_t largest : {0u, 1u, 30u, 3000u, 90000u}) {
      std::uniform_int_distribution<std::uint32_t> any(0, largest);
      SquaredLines a(length), b(length), c(length);
      std::vector<std::vector<std::int64_t>> value(SquaredLines::lanes);
      for (int i = 0; i < length; ++i)
        for (std::size_t l = 0; l < SquaredLines::lanes; ++l) {
          const std::uint32_t v = any(rng);
          value[l].push_back(v);
          a.at(i)[l] = b.at(i)[l] = c.at(i)[l] = v;
        }
      a.search_outwards();
      b.lower_envelope();
      c.run();
      for (int i = 0; i < length; ++i)
        for (std::size_t l = 0; l < SquaredLines::lanes; ++l) {
          const std::int64_t left = i + 1, right = length - i;
          std::int64_t least = std::min(left * left, right * right);
          for (int j = 0; j < length; ++j)
            least = std::min(least,
                             value[l][static_cast<std::size_t>(j)] + std::int64_t{i - j} * (i - j));
          ASSERT_EQ(a.at(i)[l], least) << "position " << i << " of " << length;
          ASSERT_EQ(b.at(i)[l], least) << "position " << i << " of " << length;
          ASSERT_EQ(c.at(i)[l], least) << "position " << i << " of " << length;
        }
    }
  }
}

}  // namespace
}  // namespace lacuna
