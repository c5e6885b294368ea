#include "analysis/regions/stray_pieces.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "analysis/geometry/disjoint_sets.h"
#include "analysis/space/sweep.h"

namespace lacuna {

namespace {

/// Voxels [x0, x1) of a row, of one region. `lead` is a run of the same piece that comes no later.
struct Run {
  std::uint16_t x0, x1;
  std::uint32_t label;
  std::uint64_t lead;
};

class Pieces {
 public:
  Pieces(RegionLabels& labels, const ThreadPool& pool)
      : labels_(labels), pool_(pool), size_(labels.label.size()) {
    find_runs();
    join_runs();
    for (Run& run : runs_) run.lead = runs_[run.lead].lead;  // the first of a piece leads to itself
    anchored_.assign(runs_.size(), false);
    for (const Region& region : labels.regions) anchored_[lead_at(region.root)] = true;
  }

  /// One round: every piece beside an anchored one joins the best. False if none is left.
  std::size_t join_round() {
    std::map<std::uint64_t, std::map<std::uint32_t, std::uint64_t>> faces;  // stray piece, label
    for_each_stray([&](const Run& run, int y, int z) { count_faces(run, y, z, faces[run.lead]); });
    std::map<std::uint64_t, std::uint32_t> chosen;
    for (const auto& [piece, by_label] : faces) {
      const auto best = std::max_element(by_label.begin(), by_label.end(), [](auto& a, auto& b) {
        return a.second < b.second;  // the first, that is the lowest label, among equals
      });
      if (best != by_label.end()) chosen[piece] = best->first;
    }
    for_each_stray([&](Run& run, int y, int z) {
      const auto found = chosen.find(run.lead);
      if (found != chosen.end()) relabel(run, y, z, found->second);
    });
    for (const auto& [piece, label] : chosen) anchored_[piece] = true;
    return chosen.size();
  }

 private:
  std::size_t row(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) +
           static_cast<std::size_t>(y);
  }

  template <class Visit>
  void for_each_run_of(int y, int z, Visit&& visit) const {
    const std::uint32_t* label = labels_.label.row(y, z);
    for (int x = 0; x < size_.x;) {
      int end = x + 1;
      while (end < size_.x && label[end] == label[x]) ++end;
      if (label[x] != no_region) visit(x, end, label[x]);
      x = end;
    }
  }

  void find_runs() {
    first_.assign(static_cast<std::size_t>(size_.y) * static_cast<std::size_t>(size_.z) + 1, 0);
    run_parallel(pool_, size_.z, [&](int z) {
      for (int y = 0; y < size_.y; ++y)
        for_each_run_of(y, z, [&](int, int, std::uint32_t) { ++first_[row(y, z) + 1]; });
    });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    runs_.resize(first_.back());
    run_parallel(pool_, size_.z, [&](int z) {
      for (int y = 0; y < size_.y; ++y) {
        std::uint64_t i = first_[row(y, z)];
        for_each_run_of(y, z, [&](int x0, int x1, std::uint32_t label) {
          runs_[i] = {static_cast<std::uint16_t>(x0), static_cast<std::uint16_t>(x1), label, i};
          ++i;
        });
      }
    });
  }

  void join_rows(std::size_t row_a, std::size_t row_b) {
    std::uint64_t a = first_[row_a], b = first_[row_b];
    while (a < first_[row_a + 1] && b < first_[row_b + 1]) {
      const Run &p = runs_[a], &q = runs_[b];
      if (p.label == q.label && p.x0 < q.x1 && q.x0 < p.x1) {
        join_sets(a, b, [this](std::uint64_t i) -> std::uint64_t& { return runs_[i].lead; });
      }
      if (p.x1 <= q.x1)
        ++a;
      else
        ++b;
    }
  }

  void join_runs() {
    for (int z = 0; z < size_.z; ++z)
      for (int y = 0; y < size_.y; ++y) {
        if (y > 0) join_rows(row(y - 1, z), row(y, z));
        if (z > 0) join_rows(row(y, z - 1), row(y, z));
      }
  }

  std::uint64_t lead_at(std::size_t voxel) const {
    const Imath::V3i v = labels_.label.voxel(voxel);
    const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(first_[row(v.y, v.z)]);
    const auto end = runs_.begin() + static_cast<std::ptrdiff_t>(first_[row(v.y, v.z) + 1]);
    return (std::upper_bound(begin, end, v.x, [](int x, const Run& run) { return x < run.x0; }) - 1)
        ->lead;
  }

  template <class Visit>
  void for_each_stray(Visit&& visit) {
    for (int z = 0; z < size_.z; ++z)
      for (int y = 0; y < size_.y; ++y)
        for (std::uint64_t i = first_[row(y, z)]; i < first_[row(y, z) + 1]; ++i)
          if (!anchored_[runs_[i].lead]) visit(runs_[i], y, z);
  }

  /// Adds the faces between a run and anchored pieces, by their label.
  void count_faces(const Run& run, int y, int z, std::map<std::uint32_t, std::uint64_t>& faces) {
    for (int x = run.x0; x < run.x1; ++x)
      for (const Imath::V3i& w :
           {Imath::V3i(x - 1, y, z), Imath::V3i(x + 1, y, z), Imath::V3i(x, y - 1, z),
            Imath::V3i(x, y + 1, z), Imath::V3i(x, y, z - 1), Imath::V3i(x, y, z + 1)}) {
        if (!in_grid(w, size_) || labels_.label(w) == no_region) continue;
        if (anchored_[lead_at(labels_.label.index(w))]) ++faces[labels_.label(w)];
      }
  }

  void relabel(Run& run, int y, int z, std::uint32_t label) {
    const auto voxels = static_cast<std::uint64_t>(run.x1 - run.x0);
    labels_.regions[run.label].voxels -= voxels;
    labels_.regions[label].voxels += voxels;
    run.label = label;
    std::fill(labels_.label.row(y, z) + run.x0, labels_.label.row(y, z) + run.x1, label);
  }

  RegionLabels& labels_;
  const ThreadPool& pool_;
  Imath::V3i size_;
  std::vector<std::uint64_t> first_;  // rows + 1 offsets into runs_
  std::vector<Run> runs_;
  std::vector<bool> anchored_;  // by a piece's first run: it holds its region's root, or has joined
};

}  // namespace

std::size_t join_stray_pieces(RegionLabels& labels, const ThreadPool& pool) {
  if (labels.regions.empty()) return 0;
  Pieces pieces(labels, pool);
  std::size_t joined = 0;
  while (const std::size_t n = pieces.join_round()) joined += n;
  return joined;
}

}  // namespace lacuna
