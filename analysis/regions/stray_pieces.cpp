#include "analysis/regions/stray_pieces.h"

#include <algorithm>
#include <map>

#include "analysis/space/run_components.h"

namespace lacuna {

namespace {

/// The connected components of equal labels: each is a piece of a region.
RunComponents find_pieces(const Grid3<std::uint32_t>& label, const ThreadPool& pool) {
  const auto value = [&label](Imath::V3i v) { return label(v); };
  return label_runs(label.size(), EqualValueRows(value, no_region, label.size().x),
                    Connectivity::faces, pool);
}

class Pieces {
 public:
  Pieces(RegionLabels& labels, const ThreadPool& pool)
      : labels_(labels), pieces_(find_pieces(labels.label, pool)), anchored_(pieces_.count()) {
    for (const Region& region : labels.regions)
      anchored_[pieces_.at(labels.label.voxel(region.root))] = true;
  }

  /// One round: every piece beside an anchored one joins the best. False if none is left.
  std::size_t join_round() {
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint64_t>> faces;  // stray piece, label
    for_each_stray([&](const ComponentRun& run, int y, int z) {
      count_faces(run, y, z, faces[run.component]);
    });
    std::map<std::uint32_t, std::uint32_t> chosen;
    for (const auto& [piece, by_label] : faces) {
      const auto best = std::max_element(by_label.begin(), by_label.end(), [](auto& a, auto& b) {
        return a.second < b.second;  // the first, that is the lowest label, among equals
      });
      if (best != by_label.end()) chosen[piece] = best->first;
    }
    for_each_stray([&](const ComponentRun& run, int y, int z) {
      const auto found = chosen.find(run.component);
      if (found != chosen.end()) relabel(run, y, z, found->second);
    });
    for (const auto& [piece, label] : chosen) anchored_[piece] = true;
    return chosen.size();
  }

 private:
  template <class Visit>
  void for_each_stray(const Visit& visit) const {
    pieces_.for_each_run([&](const ComponentRun& run, int y, int z) {
      if (!anchored_[run.component]) visit(run, y, z);
    });
  }

  /// Adds the faces between a run and anchored pieces, by their label.
  void count_faces(const ComponentRun& run, int y, int z,
                   std::map<std::uint32_t, std::uint64_t>& faces) const {
    for (int x = run.x0; x < run.x1; ++x)
      for (const Imath::V3i& w :
           {Imath::V3i(x - 1, y, z), Imath::V3i(x + 1, y, z), Imath::V3i(x, y - 1, z),
            Imath::V3i(x, y + 1, z), Imath::V3i(x, y, z - 1), Imath::V3i(x, y, z + 1)}) {
        if (!in_grid(w, labels_.label.size()) || labels_.label(w) == no_region) continue;
        if (anchored_[pieces_.at(w)]) ++faces[labels_.label(w)];
      }
  }

  void relabel(const ComponentRun& run, int y, int z, std::uint32_t label) {
    std::uint32_t* const row = labels_.label.row(y, z);
    const auto voxels = static_cast<std::uint64_t>(run.x1 - run.x0);
    labels_.regions[row[run.x0]].voxels -= voxels;
    labels_.regions[label].voxels += voxels;
    std::fill(row + run.x0, row + run.x1, label);
  }

  RegionLabels& labels_;
  RunComponents pieces_;
  std::vector<bool> anchored_;  // by piece: it holds its region's root, or has joined
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
