#include "analysis/regions/forest_labels.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "analysis/regions/stray_pieces.h"
#include "analysis/space/run_components.h"

// The forest's grid of centres is converted to labels in place: touching roots of equal opening are
// components, every voxel points to the first voxel of its root's component, and these get the
// component's number.

namespace lacuna {

namespace {

class Labeller {
 public:
  Labeller(OpeningForest& forest, const ThreadPool& pool)
      : opening_(forest.opening), lead_(forest.centre), pool_(pool) {}

  /// Writes the labels into the grid of centres.
  std::vector<Region> run() {
    lead_roots();
    for_each_plane([&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        if (lead(i) != no_voxel) lead_to_end(i);
    });
    label_voxels();
    return std::move(regions_);
  }

 private:
  // Other threads may shorten the chain meanwhile: each link is old or new, and both lead to the
  // same end.
  std::uint32_t lead(std::size_t i) const {
    return std::atomic_ref<std::uint32_t>(lead_[i]).load(std::memory_order_relaxed);
  }
  void set_lead(std::size_t i, std::uint32_t to) {
    std::atomic_ref<std::uint32_t>(lead_[i]).store(to, std::memory_order_relaxed);
  }
  void lead_to_end(std::size_t i) {
    std::uint32_t end = lead(i);
    for (std::uint32_t next; (next = lead(end)) != end;) end = next;
    set_lead(i, end);
  }

  /// Calls visit(begin, end), indices of voxels, for every plane.
  template <class Visit>
  void for_each_plane(const Visit& visit) {
    const auto depth = static_cast<std::size_t>(lead_.size().z);
    const std::size_t plane = lead_.count() / depth;
    run_parallel(pool_, lead_.size().z, [&](int z) {
      visit(plane * static_cast<std::size_t>(z), plane * (static_cast<std::size_t>(z) + 1));
    });
  }

  void lead_roots();
  void label_voxels();

  const Grid3<std::uint16_t>& opening_;
  Grid3<std::uint32_t>& lead_;  // the voxel that each points to; itself at the end
  const ThreadPool& pool_;
  std::vector<Region> regions_;
};

/// Makes a region of every component of roots; its first voxel leads the others.
void Labeller::lead_roots() {
  const auto opening_of_root = [this](Imath::V3i v) {  // 0 in no region
    return lead_(v) == lead_.index(v) ? opening_(v) : std::uint16_t{0};
  };
  const RunComponents roots =
      label_runs(lead_.size(), EqualValueRows(opening_of_root, std::uint16_t{0}, lead_.size().x),
                 Connectivity::faces, pool_);
  roots.for_each_run([&](const ComponentRun& run, int y, int z) {
    std::uint32_t* const row = lead_.row(y, z);
    if (run.component == regions_.size()) {
      const std::size_t first = lead_.index(run.x0, y, z);
      regions_.push_back({.opening = opening_[first], .root = static_cast<std::uint32_t>(first)});
    }
    std::fill(row + run.x0, row + run.x1, regions_[run.component].root);
  });
}

void Labeller::label_voxels() {
  for (std::size_t r = 0; r < regions_.size(); ++r)
    lead_[regions_[r].root] = static_cast<std::uint32_t>(r);  // a label from here on, not an index
  for_each_plane([&](std::size_t begin, std::size_t end) {
    auto next = std::lower_bound(regions_.begin(), regions_.end(), begin,
                                 [](const Region& r, std::size_t i) { return r.root < i; });
    std::uint32_t label = no_region;
    std::uint64_t same = 0;  // voxels of `label` in a row: counted together
    const auto count = [&] {
      if (label != no_region)
        std::atomic_ref<std::uint64_t>(regions_[label].voxels)
            .fetch_add(same, std::memory_order_relaxed);
      same = 0;
    };
    for (std::size_t i = begin; i < end; ++i) {
      if (next != regions_.end() && next->root == i)
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
