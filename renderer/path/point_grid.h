#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "analysis/geometry/simd.h"
#include "base/parallel/thread_pool.h"
#include "renderer/core/key_sort.h"
#include "renderer/core/rng.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// A hash grid of points, which finds all points within a radius of a position. Cells are twice the
/// radius wide, so a ball touches at most two along each axis. The points are sorted by the hash of
/// their cell. Neighbouring cells along x are neighbours in memory, so a query reads four runs of
/// points, eight points at a time.
///
/// Time and memory of build() are linear in the number of points, for any radius. The order of the
/// points, and so of the results of a query, does not depend on the number of threads.
class PointGrid {
 public:
  /// The number of candidates above which a query visits a random subset, of about this size. So
  /// the time of many queries stays linear even if the radius is as large as the scene or if all
  /// points coincide.
  static constexpr std::uint32_t most_candidates = 1 << 12;

  /// `radius`: the largest of a query; > 0, and at least 2^-20 times the largest coordinate,
  /// because of the precision of floats. At most 2^32 - 1 points.
  void build(std::span<const V3f> points, double radius, const ThreadPool& pool);

  std::size_t size() const { return order_.size(); }
  /// order()[k]: the index of the point that is at `k` in the sorted order.
  std::span<const std::uint32_t> order() const { return {order_.begin(), order_.end()}; }

  /// Calls `visit(k, distance2, count)` for the points within `radius` of `x`, with k as in
  /// order(); `radius` is at most that of build(). `count` is 1. Of more than most_candidates
  /// candidates, only every count-th is visited, from a random start: a sum over the visited
  /// points, each times `count`, is an unbiased estimate of the sum over all.
  template <class Visit>
  void for_each_within(const V3f& x, float radius, Rng& rng, Visit&& visit) const {
    if (order_.empty()) return;
    Query query;
    const std::span<const Row> rows = rows_around(x, query);
    std::uint64_t candidates = 0;
    for (const Row& row : rows) candidates += row.end - row.begin;
    if (candidates <= most_candidates) {
      for (const Row& row : rows) visit_row(x, radius, row, visit);
      return;
    }
    const auto step = static_cast<std::uint32_t>((candidates - 1) / most_candidates + 1);
    std::uint64_t next = rng.below(step);
    for (const Row& row : rows) {
      const std::uint64_t n = row.end - row.begin;
      for (; next < n; next += step) {
        visit_point(x, radius, row, row.begin + static_cast<std::uint32_t>(next),
                    [&](std::uint32_t k, float distance2) {
                      visit(k, distance2, static_cast<float>(step));
                    });
      }
      next -= n;
    }
  }

 private:
  /// Two neighbouring cells along x: [begin, end) are their points, and others of the same hash.
  struct Row {
    int y, z;
    std::uint32_t begin, end;
  };
  /// Four rows; one that continues at the first bucket counts as two.
  using Query = std::array<Row, 8>;
  int cell(float x) const { return static_cast<int>(std::floor(double(x) * per_cell_)); }
  static std::uint64_t hash(int y, int z) {
    std::uint64_t h = static_cast<std::uint32_t>(y) | std::uint64_t{static_cast<std::uint32_t>(z)}
                                                          << 32;
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93;  // a mixer of 64 bits (Maiga 2018)
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93;
    return h ^ (h >> 32);
  }
  std::uint32_t bucket(int x, int y, int z) const {
    return static_cast<std::uint32_t>(hash(y, z) + static_cast<std::uint64_t>(x)) & mask_;
  }
  std::uint32_t bucket(const V3f& p) const { return bucket(cell(p.x), cell(p.y), cell(p.z)); }

  std::span<const Row> rows_around(const V3f& x, Query& rows) const {
    // The lower of the two cells contains the lower end of the ball.
    const auto lower = [&](float at) {
      return static_cast<int>(std::floor((double(at) - reach_) * per_cell_));
    };
    const int cx = lower(x.x), cy = lower(x.y), cz = lower(x.z);
    std::size_t n = 0;
    for (int i = 0; i < 4; ++i) {
      const int y = cy + (i & 1), z = cz + (i >> 1);
      const std::uint32_t first = bucket(cx, y, z);
      if (first < mask_) {
        rows[n++] = {y, z, starts_[first], starts_[first + 2]};
      } else {
        rows[n++] = {y, z, starts_[first], starts_[first + 1]};
        rows[n++] = {y, z, starts_[0], starts_[1]};
      }
    }
    return std::span(rows).first(n);
  }

  /// Whether point `k` is in a cell of the row: cells with the same hash share a bucket, and a
  /// point must count in one row only.
  bool in_row(const Row& row, std::size_t k) const {
    return cell(y_[k]) == row.y && cell(z_[k]) == row.z;
  }

  template <class Visit>
  void visit_point(const V3f& x, float radius, const Row& row, std::uint32_t k,
                   Visit&& visit) const {
    const float dx = x_[k] - x.x, dy = y_[k] - x.y, dz = z_[k] - x.z;
    const float distance2 = dx * dx + dy * dy + dz * dz;
    if (distance2 <= radius * radius && in_row(row, k)) visit(k, distance2);
  }

  template <class Visit>
  void visit_row(const V3f& x, float radius, const Row& row, Visit&& visit) const {
    const Float8 radius2(radius * radius);
    for (std::uint32_t k = row.begin; k < row.end; k += 8) {
      const Float8 dx = Float8::load_unaligned(&x_[k]) - x.x;
      const Float8 dy = Float8::load_unaligned(&y_[k]) - x.y;
      const Float8 dz = Float8::load_unaligned(&z_[k]) - x.z;
      const Float8 distance2 = dx * dx + dy * dy + dz * dz;
      std::uint32_t found = movemask(radius2 >= distance2);
      if (row.end - k < 8) found &= (1U << (row.end - k)) - 1;
      if (found == 0) continue;
      alignas(32) std::array<float, 8> values;
      distance2.store(values.data());
      for (; found != 0; found &= found - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(found));
        if (in_row(row, k + lane)) visit(k + lane, values[lane], 1.0F);
      }
    }
  }

  double per_cell_ = 1;  ///< 1 / width of a cell
  double reach_ = 1;     ///< half a cell
  std::uint32_t mask_ = 0;
  KeySort<std::uint32_t> sort_;            // of the points' indices by bucket
  std::span<const std::uint32_t> starts_;  // first k of each bucket
  HugeArray<float> x_, y_, z_;             // in sorted order, padded to whole loads
  HugeArray<std::uint32_t> order_;
};

}  // namespace lacuna
