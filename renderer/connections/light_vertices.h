#pragma once

#include <span>
#include <vector>

#include "renderer/path/light_batch.h"

namespace lacuna {

/// The light paths of an iteration that eye paths of all pixels are joined to: `paths` of them,
/// each with up to `longest` vertices. Vertices are counted by s: 1 lies on the emitter.
class LightVertices {
 public:
  LightVertices(std::size_t paths, int longest)
      : paths_(paths),
        longest_(longest),
        emitters_(paths),
        vertices_(paths * static_cast<std::size_t>(std::max(0, longest - 1))),
        lengths_(paths, 0),
        joinable_(static_cast<std::size_t>(longest)) {}

  std::size_t paths() const { return paths_; }
  int longest() const { return longest_; }

  /// Keeps the path in place `i` of `batch` as path number `path`. Different paths may be kept by
  /// several threads at once.
  template <class Guide>
  void keep(std::size_t path, const LightBatch<Guide>& batch, std::size_t i) {
    lengths_[path] = std::min(batch.length(i), longest_);
    if (lengths_[path] > 0) emitters_[path] = batch.emitter(i);
    for (int s = 2; s <= lengths_[path]; ++s) at(path, s) = batch.vertex(i, s - 1);
  }

  /// To be called when all paths are kept: lists what can be joined.
  void list() {
    for (int s = 1; s <= longest_; ++s) {
      auto& list = joinable_[static_cast<std::size_t>(s) - 1];
      list.clear();
      for (std::uint32_t j = 0; j < paths_; ++j) {
        if (lengths_[j] >= s && (s == 1 || at(j, s).bsdf->connectible())) list.push_back(j);
      }
    }
  }

  /// The paths whose vertex `s` can be the end of a connecting edge, ascending.
  std::span<const std::uint32_t> joinable(int s) const {
    return joinable_[static_cast<std::size_t>(s) - 1];
  }

  /// Calls `use(end)` with vertex `s` of path `j`: an EmitterEnd or a SurfaceEnd.
  template <class Guide, class Use>
  decltype(auto) with_end(std::uint32_t j, int s, const Guide& guide, Use&& use) const {
    if (s == 1) return use(EmitterEnd{emitters_[j]});
    return use(SurfaceEnd<Guide>{at(j, s), s - 1, Transport::importance, guide});
  }
  const EmitterPoint& emitter(std::uint32_t j) const { return emitters_[j]; }
  const Vertex& at(std::size_t j, int s) const { return vertices_[index(j, s)]; }

 private:
  Vertex& at(std::size_t j, int s) { return vertices_[index(j, s)]; }
  std::size_t index(std::size_t j, int s) const {
    return static_cast<std::size_t>(s - 2) * paths_ + j;  // those of one length side by side
  }

  std::size_t paths_;
  int longest_;
  std::vector<EmitterPoint> emitters_;
  std::vector<Vertex> vertices_;
  std::vector<int> lengths_;
  std::vector<std::vector<std::uint32_t>> joinable_;
};

}  // namespace lacuna
