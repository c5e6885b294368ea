#include "renderer/path/point_grid.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lacuna {

namespace {

constexpr std::size_t block = 1 << 14;  // points that one thread counts and moves at a time
constexpr std::uint32_t fewest_buckets = 16;
constexpr std::uint32_t parts = 256;  // of the buckets, which are sorted apart

}  // namespace

// A counting sort in two steps, each stable: into parts of neighbouring buckets, by blocks of
// points; then within each part. Blocks and parts do not depend on the number of threads.
void PointGrid::build(std::span<const V3f> points, double radius, const ThreadPool& pool) {
  const std::size_t n = points.size();
  // A little wider than the ball, so that rounding of the cell's number loses no point.
  reach_ = radius * (1 + 0x1p-10);
  per_cell_ = 1 / (2 * reach_);
  const auto buckets =
      std::max(fewest_buckets,
               static_cast<std::uint32_t>(std::bit_ceil(std::min<std::size_t>(n, 1U << 31))));
  mask_ = buckets - 1;
  const std::uint32_t of_part = std::max(1U, buckets / parts);
  const std::uint32_t used_parts = buckets / of_part;
  const int blocks = static_cast<int>((n + block - 1) / block);

  bucket_of_.resize(n);
  std::vector<std::array<std::uint32_t, parts>> places(static_cast<std::size_t>(blocks));
  const auto each_of = [&](int b, auto&& use) {
    const std::size_t first = static_cast<std::size_t>(b) * block;
    for (std::size_t i = first; i < std::min(n, first + block); ++i) use(i);
  };
  pool.for_each(blocks, [&](int b) {
    auto& count = places[static_cast<std::size_t>(b)];
    count.fill(0);
    each_of(b, [&](std::size_t i) {
      bucket_of_[i] = bucket(points[i]);
      ++count[bucket_of_[i] / of_part];
    });
  });
  std::vector<std::uint32_t> part_starts(used_parts + 1);
  std::uint32_t sum = 0;
  for (std::uint32_t part = 0; part < used_parts; ++part) {
    part_starts[part] = sum;
    for (auto& count : places) sum += std::exchange(count[part], sum);
  }
  part_starts[used_parts] = sum;
  entries_.resize(n);
  pool.for_each(blocks, [&](int b) {
    auto& place = places[static_cast<std::size_t>(b)];
    each_of(b, [&](std::size_t i) {
      entries_[place[bucket_of_[i] / of_part]++] = {bucket_of_[i], static_cast<std::uint32_t>(i)};
    });
  });

  starts_.resize(buckets + 1);
  starts_[buckets] = static_cast<std::uint32_t>(n);
  order_.resize(n);
  for (auto* axis : {&x_, &y_, &z_}) axis->resize(n + 8);
  pool.for_each(static_cast<int>(used_parts), [&](int p) {
    const auto part = static_cast<std::uint32_t>(p);
    const auto of =
        std::span(entries_).subspan(part_starts[part], part_starts[part + 1] - part_starts[part]);
    std::vector<std::uint32_t> place(of_part, 0);
    for (const Entry& e : of) ++place[e.bucket - part * of_part];
    std::uint32_t next = part_starts[part];
    for (std::uint32_t k = 0; k < of_part; ++k) {
      starts_[part * of_part + k] = next;
      next += std::exchange(place[k], next);
    }
    for (const Entry& e : of) {
      const std::uint32_t k = place[e.bucket - part * of_part]++;
      order_[k] = e.index;
      x_[k] = points[e.index].x;
      y_[k] = points[e.index].y;
      z_[k] = points[e.index].z;
    }
  });
}

}  // namespace lacuna
