#pragma once

#include <array>
#include <cstddef>

namespace lacuna {

/// The shape of a row of a figure.
struct RowShape {
  std::array<int, 2> whole{}, detail{};  ///< sizes in pixels of the picture and of its crops
  std::size_t crops = 1, columns = 1;
  bool mapped = false;  ///< whether it has error maps
};

/// The sizes of a row: the whole picture at the left is as high as the columns at its right, which
/// all end at the right border of the page.
struct RowLayout {
  double whole_width, whole_height, detail_width, detail_height, map_height;
};

/// `gap`: between pictures, in the unit of `page_width`.
RowLayout row_layout(const RowShape& shape, double page_width, double gap);

}  // namespace lacuna
