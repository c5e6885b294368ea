#include "analysis/regions/forest_labels.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/disjoint_sets.h"
#include "analysis/regions/stray_pieces.h"
#include "analysis/space/bit_rows.h"
#include "analysis/space/sweep.h"

// The forest's grid of centres is turned into labels in place: roots that touch are joined
// (union-find, the first voxel of a region leads), every voxel is led to the first voxel of its
// region, and these are numbered.

namespace lacuna {

namespace {

class Labeller {
 public:
  Labeller(OpeningForest& forest, const ThreadPool& pool)
      : opening_(forest.opening),
        lead_(forest.centre),
        pool_(pool),
        size_(forest.centre.size()),
        is_root_(size_) {}

  /// Leaves the labels in the grid of centres.
  std::vector<Region> run() {
    mark_roots();
    join_roots();
    // Roots first: chains of the others end there, and are short.
    for_each_voxel([&](std::size_t i, bool root) {
      if (root) lead_to_end(i);
    });
    for_each_voxel([&](std::size_t i, bool root) {
      if (!root) lead_to_end(i);
    });
    return number_regions();
  }

 private:
  // Other threads may shorten the chain that is followed: each link is old or new, and both lead to
  // the same end.
  std::uint32_t lead(std::size_t i) const {
    return std::atomic_ref<std::uint32_t>(lead_[i]).load(std::memory_order_relaxed);
  }
  void set_lead(std::size_t i, std::uint32_t to) {
    std::atomic_ref<std::uint32_t>(lead_[i]).store(to, std::memory_order_relaxed);
  }

  template <class Visit>
  void for_each_voxel(Visit&& visit) {
    run_parallel(pool_, size_.z, [&](int z) {
      for (int y = 0; y < size_.y; ++y) {
        const std::size_t row = lead_.index(0, y, z);
        for (int x = 0; x < size_.x; ++x)
          if (const std::size_t i = row + static_cast<std::size_t>(x); lead(i) != no_voxel)
            visit(i, is_root_.get(x, y, z));
      }
    });
  }

  void mark_roots() {
    run_parallel(pool_, is_root_.blocks().z, [&](int bz) {  // a thread has its blocks for itself
      for (int z = 8 * bz; z < std::min(8 * bz + 8, size_.z); ++z)
        for (int y = 0; y < size_.y; ++y)
          for (int x = 0; x < size_.x; ++x)
            if (lead_(x, y, z) == lead_.index(x, y, z)) is_root_.set(x, y, z);
    });
  }

  void join_with(Imath::V3i v, Imath::V3i neighbour) {
    if (!is_root_.get(neighbour) || opening_(v) != opening_(neighbour)) return;
    join_sets(static_cast<std::uint32_t>(lead_.index(v)),
              static_cast<std::uint32_t>(lead_.index(neighbour)),
              [this](std::uint32_t i) -> std::uint32_t& { return lead_[i]; });
  }

  /// Slabs of planes each by itself, then across their seams.
  void join_roots() {
    const int slabs = std::min(size_.z, pool_.threads() == 1 ? 1 : 4 * pool_.threads());
    const auto cut = [&](int s) { return static_cast<int>(std::int64_t{size_.z} * s / slabs); };
    const auto for_each_root = [&](int z, auto&& visit) {
      BitRow row(size_.x);
      for (int y = 0; y < size_.y; ++y) {
        row.read(is_root_, y, z);
        row.for_each_run([&](int x0, int x1) {
          for (int x = x0; x < x1; ++x) visit(Imath::V3i(x, y, z));
        });
      }
    };
    run_parallel(pool_, slabs, [&](int s) {
      for (int z = cut(s); z < cut(s + 1); ++z)
        for_each_root(z, [&](Imath::V3i v) {
          if (v.x > 0) join_with(v, v - Imath::V3i(1, 0, 0));
          if (v.y > 0) join_with(v, v - Imath::V3i(0, 1, 0));
          if (z > cut(s)) join_with(v, v - Imath::V3i(0, 0, 1));
        });
    });
    for (int s = 1; s < slabs; ++s)
      for_each_root(cut(s), [&](Imath::V3i v) { join_with(v, v - Imath::V3i(0, 0, 1)); });
  }

  void lead_to_end(std::size_t i) {
    std::uint32_t end = lead(i);
    for (std::uint32_t next; (next = lead(end)) != end;) end = next;
    set_lead(i, end);
  }

  std::vector<Region> number_regions();

  const Grid3<std::uint16_t>& opening_;
  Grid3<std::uint32_t>& lead_;  // the voxel that each follows; itself at the end
  const ThreadPool& pool_;
  Imath::V3i size_;
  BitGrid3 is_root_;
};

std::vector<Region> Labeller::number_regions() {
  const auto depth = static_cast<std::size_t>(size_.z);
  const std::size_t plane = lead_.count() / depth;
  std::vector<std::vector<Region>> of_plane(depth);
  run_parallel(pool_, size_.z, [&](int z) {
    const std::size_t begin = lead_.index(0, 0, z);
    for (std::size_t i = begin; i < begin + plane; ++i)
      if (lead_[i] == i)
        of_plane[static_cast<std::size_t>(z)].push_back(
            {.opening = opening_[i], .root = static_cast<std::uint32_t>(i)});
  });
  std::vector<Region> regions;
  std::vector<std::size_t> first;  // region of each plane
  for (auto& found : of_plane) {
    first.push_back(regions.size());
    regions.insert(regions.end(), found.begin(), found.end());
    std::vector<Region>().swap(found);
  }
  for (std::size_t r = 0; r < regions.size(); ++r)
    lead_[regions[r].root] = static_cast<std::uint32_t>(r);  // from here on a label, not an index
  run_parallel(pool_, size_.z, [&](int z) {
    const std::size_t begin = lead_.index(0, 0, z);
    std::size_t next = first[static_cast<std::size_t>(z)];
    std::uint32_t label = no_region;
    std::uint64_t same = 0;  // voxels of `label` in a row: counted together
    const auto count = [&] {
      if (label != no_region)
        std::atomic_ref<std::uint64_t>(regions[label].voxels)
            .fetch_add(same, std::memory_order_relaxed);
      same = 0;
    };
    for (std::size_t i = begin; i < begin + plane; ++i) {
      if (next < regions.size() && regions[next].root == i)
        ++next;
      else if (lead_[i] != no_voxel)
        lead_[i] = lead_[lead_[i]];
      if (lead_[i] != label) {
        count();
        label = lead_[i];
      }
      ++same;
    }
    count();
  });
  return regions;
}

}  // namespace

static_assert(no_region == no_voxel, "voxels outside the domain keep their value");

RegionLabels forest_labels(OpeningForest forest, const ThreadPool& pool) {
  RegionLabels labels;
  if (forest.centre.count() > 0) labels.regions = Labeller(forest, pool).run();
  labels.label = std::move(forest.centre);
  labels.opening = std::move(forest.opening);
  labels.pieces_joined = join_stray_pieces(labels, pool);
  return labels;
}

}  // namespace lacuna
