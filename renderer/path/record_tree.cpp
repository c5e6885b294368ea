#include "renderer/path/record_tree.h"

#include <algorithm>
#include <array>
#include <nanoflann.hpp>

namespace lacuna {

namespace {

constexpr std::size_t most_candidates = 128;  // of a query

}  // namespace

struct RecordTree::Impl {
  /// The interface that nanoflann reads.
  struct Places {
    std::vector<SurfacePoint> list;
    std::size_t kdtree_get_point_count() const { return list.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const {
      return list[i].x[static_cast<int>(axis)];
    }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Places>,
                                                    Places, 3, std::uint32_t>;

  explicit Impl(std::vector<SurfacePoint> list)
      : points{std::move(list)}, index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(8)) {
    index.buildIndex();
  }
  Places points;
  Index index;
};

RecordTree::RecordTree() = default;
RecordTree::~RecordTree() = default;
RecordTree::RecordTree(RecordTree&&) noexcept = default;
RecordTree& RecordTree::operator=(RecordTree&&) noexcept = default;

void RecordTree::build(std::vector<SurfacePoint> points) {
  impl_ = points.empty() ? nullptr : std::make_unique<Impl>(std::move(points));
}

std::size_t RecordTree::nearest(const SurfacePoint& at, std::span<std::uint32_t> found) const {
  if (impl_ == nullptr) return 0;
  const std::size_t wanted = std::min(2 * found.size(), most_candidates);
  std::array<std::uint32_t, most_candidates> index;
  std::array<float, most_candidates> distance2;
  const std::size_t n = impl_->index.knnSearch(&at.x.x, wanted, index.data(), distance2.data());
  std::array<std::pair<float, std::uint32_t>, most_candidates> ranked;
  for (std::size_t i = 0; i < n; ++i) {
    ranked[i] = {rank(at, impl_->points.list[index[i]]), index[i]};
  }
  const std::size_t taken = std::min(found.size(), n);
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(taken),
                    ranked.begin() + static_cast<std::ptrdiff_t>(n));
  for (std::size_t i = 0; i < taken; ++i) found[i] = ranked[i].second;
  return taken;
}

}  // namespace lacuna
