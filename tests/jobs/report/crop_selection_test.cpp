#include "jobs/report/crop_selection.h"

#include <gtest/gtest.h>

namespace lacuna {
namespace {

constexpr int wide = 64, high = 48, square = 16;

/// A grey picture of ones with one square of another value.
std::vector<double> with_square(const PixelRect& at, double value) {
  std::vector<double> rgb(3 * wide * high, 1.0);
  for (int y = at.y; y < at.y + at.height; ++y) {
    for (int k = 3 * at.x; k < 3 * (at.x + at.width); ++k) {
      rgb[static_cast<std::size_t>(3 * y * wide + k)] = value;
    }
  }
  return rgb;
}

constexpr PixelRect left{8, 8, square, square}, right{40, 24, square, square};

TEST(CropSelection, AreWhereErrorsDifferAndNotWhereTheyAreLargest) {
  const std::vector<double> reference(3 * wide * high, 1.0);
  CropSelection crops({wide, high}, square);
  // At the left both methods are far off, at the right only one is, and less.
  std::vector<double> first = with_square(left, 5), second = first;
  const std::vector<double> at_right = with_square(right, 2);
  for (std::size_t i = 0; i < first.size(); ++i) first[i] += at_right[i] - 1;
  crops.add(first, reference);
  crops.add(second, reference);
  EXPECT_EQ(crops.choose(1), std::vector<PixelRect>{right});

  CropSelection alone({wide, high}, square);
  alone.add(first, reference);
  EXPECT_EQ(alone.choose(1), std::vector<PixelRect>{left}) << "of one method, the largest";
  EXPECT_EQ(alone.choose(2), (std::vector<PixelRect>{left, right}));
}

TEST(CropSelection, ShareNoPixels) {
  CropSelection crops({wide, high}, square);
  crops.add(with_square(left, 2), std::vector<double>(3 * wide * high, 1.0));
  const std::vector<PixelRect> found = crops.choose(4);
  ASSERT_EQ(found.size(), 4u);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_TRUE(is_inside(found[i], wide, high));
    for (std::size_t k = 0; k < i; ++k) {
      const bool apart = std::abs(found[i].x - found[k].x) >= square ||
                         std::abs(found[i].y - found[k].y) >= square;
      EXPECT_TRUE(apart) << i << ' ' << k;
    }
  }
}

TEST(CropSelection, WithoutAReferenceCompareWithTheFirstPicture) {
  CropSelection crops({wide, high}, square);
  crops.add(std::vector<double>(3 * wide * high, 1.0), {});
  ASSERT_EQ(crops.choose(2).size(), 1u) << "nothing is known yet: the middle";
  EXPECT_TRUE(is_inside(crops.choose(2).front(), wide, high));
  crops.add(with_square(right, 3), {});
  EXPECT_EQ(crops.choose(1), std::vector<PixelRect>{right});
}

}  // namespace
}  // namespace lacuna
