#include "renderer/path/point_grid.h"

#include <algorithm>
#include <bit>

namespace lacuna {

namespace {

constexpr std::size_t block = 1 << 14;  // points that one thread sorts at a time
constexpr std::uint32_t fewest_buckets = 16;

}  // namespace

void PointGrid::build(std::span<const V3f> points, double radius, const ThreadPool& pool) {
  const std::size_t n = points.size();
  // A little wider than the ball, so that rounding of the cell's number loses no point.
  reach_ = radius * (1 + 0x1p-10);
  per_cell_ = 1 / (2 * reach_);
  const auto buckets =
      std::max(fewest_buckets,
               static_cast<std::uint32_t>(std::bit_ceil(std::min<std::size_t>(n, 1U << 31))));
  mask_ = buckets - 1;
  order_.resize(n);
  for (auto* axis : {&x_, &y_, &z_}) {
    axis->resize(n + 8);
    std::fill(axis->end() - 8, axis->end(), 0.0F);
  }
  sort_.sort((n + block - 1) / block, buckets,
             [&](std::size_t b, const auto& use) {
               const std::size_t end = std::min(n, (b + 1) * block);
               for (std::size_t i = b * block; i < end; ++i) {
                 use(bucket(points[i]), static_cast<std::uint32_t>(i));
               }
             },
             [&](std::size_t k, std::uint32_t i) {
               order_.set(k, i);
               x_.set(k, points[i].x);
               y_.set(k, points[i].y);
               z_.set(k, points[i].z);
             },
             pool);
  starts_ = sort_.starts();
}

}  // namespace lacuna
