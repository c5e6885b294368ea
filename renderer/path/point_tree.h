#pragma once

#include <cstdint>
#include <span>

#include "base/parallel/thread_pool.h"
#include "renderer/core/huge_pages.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// A balanced k-d tree of points, for the nearest of them. The nodes of a level divide the points
/// in order into equally many; each node has the box of its points, so that a query ends early also
/// where many points are at one place. The tree does not depend on the number of threads.
class PointTree {
 public:
  /// At most 2^32 - 1 points.
  void build(std::span<const V3f> points, const ThreadPool& pool);

  struct Found {
    float distance2;
    std::uint32_t index;
    bool operator<(const Found& o) const { return distance2 < o.distance2; }
  };
  /// Writes the points nearest to `x` into `found`, those closer than the root of `radius2`, at
  /// most found.size() >= 1, the farthest first and the others in any order. Returns how many.
  std::size_t nearest(const V3f& x, float radius2, std::span<Found> found) const;

 private:
  struct Box {
    V3f low, high;
  };
  struct Entry {
    V3f x;
    std::uint32_t index;
  };
  struct Query;

  /// The first point of node `k` of `level`; the end of node k - 1.
  std::size_t begin_of(int level, std::size_t k) const { return (entries_.size() * k) >> level; }
  Box& box(int level, std::size_t k) { return boxes_[(std::size_t{1} << level) + k]; }
  const Box& box(int level, std::size_t k) const { return boxes_[(std::size_t{1} << level) + k]; }
  /// Divides the points of a node between its children, and of theirs, down to the leaves.
  void divide_all(int level, std::size_t k);
  void divide(int level, std::size_t k);
  void search(int level, std::size_t k, Query& query) const;

  int leaf_level_ = 0;
  HugeVector<Box> boxes_;  ///< node k of level l: number 2^l + k
  HugeVector<Entry> entries_;
};

}  // namespace lacuna
