#pragma once

#include <Imath/ImathVec.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "analysis/geometry/disjoint_sets.h"

namespace lacuna {

/// One row of cells along x, one bit per cell: which exist, and which are linked to the preceding
/// cell along x, y and z (where both exist).
struct CellRow {
  std::vector<std::uint64_t> present, link_x, link_y, link_z;
  explicit CellRow(int width)
      : present(words(width)), link_x(words(width)), link_y(words(width)), link_z(words(width)) {}
  static std::size_t words(int width) { return (static_cast<std::size_t>(width) + 63) / 64; }
};

/// Connected components of linked cells, by runs along x: time and memory are proportional to the
/// number of runs, not of cells.
class RunComponents {
 public:
  /// `fill(y, z, row)` fills in the row; bits beyond the width must be 0. Called once for each row,
  /// y fastest.
  RunComponents(Imath::V3i cells, const std::function<void(int, int, CellRow&)>& fill);

  /// Number of components.
  std::uint32_t count() const { return count_; }
  /// The component of an existing cell, 0 to count - 1, numbered by their first cells.
  std::uint32_t of(Imath::V3i cell) const;

 private:
  struct Run {
    std::int32_t begin, end;  // cells
  };
  void add_runs(const CellRow& row, int width);
  void join_rows(std::size_t row, std::size_t other, const std::vector<std::uint64_t>& link);

  Imath::V3i cells_;
  std::vector<std::uint32_t> first_;  // of a row, in runs_
  std::vector<Run> runs_;
  DisjointSets sets_{0};              // of runs
  std::vector<std::uint32_t> label_;  // of a run
  std::uint32_t count_ = 0;
};

}  // namespace lacuna
