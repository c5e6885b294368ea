#include "renderer/path/point_tree.h"

#include <algorithm>

namespace lacuna {

namespace {

constexpr std::size_t most_in_leaf = 8;
constexpr int shared_levels = 6;  // whose nodes are divided one by one, those below together

}  // namespace

void PointTree::build(std::span<const V3f> points, const ThreadPool& pool) {
  entries_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    entries_[i] = {points[i], static_cast<std::uint32_t>(i)};
  }
  leaf_level_ = 0;
  while (points.size() > most_in_leaf << leaf_level_) ++leaf_level_;
  boxes_.resize(std::size_t{2} << leaf_level_);
  const int shared = std::min(shared_levels, leaf_level_);
  for (int level = 0; level < shared; ++level) {
    pool.for_each(1 << level, [&](int k) { divide(level, static_cast<std::size_t>(k)); });
  }
  pool.for_each(1 << shared, [&](int k) { divide_all(shared, static_cast<std::size_t>(k)); });
}

void PointTree::divide_all(int level, std::size_t k) {
  divide(level, k);
  if (level == leaf_level_) return;
  divide_all(level + 1, 2 * k);
  divide_all(level + 1, 2 * k + 1);
}

void PointTree::divide(int level, std::size_t k) {
  const std::size_t begin = begin_of(level, k);
  const auto node = std::span(entries_).subspan(begin, begin_of(level, k + 1) - begin);
  if (node.empty()) return;
  Box& box = this->box(level, k) = {node[0].x, node[0].x};
  for (const Entry& e : node) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], e.x[axis]);
      box.high[axis] = std::max(box.high[axis], e.x[axis]);
    }
  }
  if (level == leaf_level_) return;
  const V3f size = box.high - box.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t half = begin_of(level + 1, 2 * k + 1) - begin;
  std::nth_element(node.begin(), node.begin() + static_cast<std::ptrdiff_t>(half), node.end(),
                   [axis](const Entry& a, const Entry& b) { return a.x[axis] < b.x[axis]; });
}

struct PointTree::Query {
  V3f x;
  float radius2;  // of the farthest point that may still be found
  std::span<Found> found;
  std::size_t count = 0;  // of `found`: a heap, the farthest first

  float distance2(const Box& b) const {
    float sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float d = std::max({b.low[axis] - x[axis], x[axis] - b.high[axis], 0.0F});
      sum += d * d;
    }
    return sum;
  }
  void add(const Entry& e) {
    const float distance2 = (e.x - x).length2();
    if (!(distance2 < radius2)) return;
    if (count == found.size()) std::pop_heap(found.begin(), found.end()), --count;
    found[count++] = {distance2, e.index};
    std::push_heap(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    if (count == found.size()) radius2 = found[0].distance2;
  }
};

std::size_t PointTree::nearest(const V3f& x, float radius2, std::span<Found> found) const {
  if (entries_.empty()) return 0;
  Query query{x, radius2, found};
  search(0, 0, query);
  return query.count;
}

void PointTree::search(int level, std::size_t k, Query& query) const {
  if (level == leaf_level_) {
    for (std::size_t i = begin_of(level, k); i < begin_of(level, k + 1); ++i) {
      query.add(entries_[i]);
    }
    return;
  }
  std::size_t near = 2 * k, far = near + 1;
  float to_near = query.distance2(box(level + 1, near));
  float to_far = query.distance2(box(level + 1, far));
  if (to_far < to_near) std::swap(near, far), std::swap(to_near, to_far);
  if (to_near < query.radius2) search(level + 1, near, query);
  if (to_far < query.radius2) search(level + 1, far, query);
}

}  // namespace lacuna
