#include "renderer/path/point_tree.h"

#include <algorithm>
#include <nanoflann.hpp>

namespace lacuna {

namespace {

constexpr std::size_t most_in_leaf = 8;

/// The data set that nanoflann reads.
struct Points {
  std::vector<V3f> list;
  std::size_t kdtree_get_point_count() const { return list.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return list[i][static_cast<int>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// The result set that nanoflann fills: a heap, the farthest first.
struct Nearest {
  float radius2;  // of the farthest point that may still be found
  std::span<PointTree::Found> found;
  std::size_t count = 0;

  std::size_t size() const { return count; }
  static bool full() { return true; }
  float worstDist() const { return radius2; }
  bool addPoint(float distance2, std::uint32_t index) {
    if (!(distance2 < radius2)) return true;
    if (count == found.size()) std::pop_heap(found.begin(), found.end()), --count;
    found[count++] = {distance2, index};
    std::push_heap(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count));
    if (count == found.size()) radius2 = found[0].distance2;
    return true;
  }
};

}  // namespace

struct PointTree::Impl {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                    Points, 3, std::uint32_t>;

  explicit Impl(std::vector<V3f> list)
      : points{std::move(list)},
        index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(most_in_leaf)) {
    index.buildIndex();
  }
  Points points;
  Index index;
};

PointTree::PointTree() = default;
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

void PointTree::build(std::vector<V3f> points) {
  impl_ = points.empty() ? nullptr : std::make_unique<Impl>(std::move(points));
}

std::size_t PointTree::nearest(const V3f& x, float radius2, std::span<Found> found) const {
  if (impl_ == nullptr) return 0;
  Nearest result{radius2, found};
  impl_->index.findNeighbors(result, &x.x, nanoflann::SearchParams());
  return result.count;
}

}  // namespace lacuna
