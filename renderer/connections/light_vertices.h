#pragma once

#include <immintrin.h>

#include <vector>

#include "renderer/path/light_batch.h"

namespace lacuna {

/// The light paths of an iteration that eye paths of all pixels are joined to: `paths` of them, each
/// with up to `longest` vertices. Vertices are counted by s: 1 lies on the emitter.
class LightVertices {
 public:
  LightVertices(std::size_t paths, int longest)
      : paths_(paths),
        longest_(longest),
        lengths_(paths, 0),
        emitters_(paths),
        vertices_(static_cast<std::size_t>(std::max(0, longest - 1)), std::vector<Vertex>(paths)) {}

  std::size_t paths() const { return paths_; }
  int longest() const { return longest_; }

  /// Keeps the path in place `i` of `batch` as path number `path`. Different paths may be kept by
  /// several threads at once.
  template <class Guide>
  void keep(std::size_t path, const LightBatch<Guide>& batch, std::size_t i) {
    lengths_[path] = std::min(batch.length(i), longest_);
    if (lengths_[path] > 0) emitters_[path] = batch.emitter(i);
    for (int s = 2; s <= lengths_[path]; ++s) of(s)[path] = batch.vertex(i, s - 1);
  }

  /// To be called when all paths are kept: leaves what can be joined, side by side, in the order of
  /// the paths.
  void compact() {
    for (int s = 2; s <= longest_; ++s) {
      std::vector<Vertex>& list = of(s);
      std::size_t n = 0;
      for (std::size_t j = 0; j < paths_; ++j) {
        if (lengths_[j] < s || !list[j].bsdf->connectible()) continue;
        if (n != j) list[n] = list[j];
        ++n;
      }
      list.resize(n);
    }
    std::size_t n = 0;
    for (std::size_t j = 0; j < paths_; ++j) {
      if (lengths_[j] > 0) emitters_[n++] = emitters_[j];
    }
    emitters_.resize(n);
  }

  /// How many vertices `s` there are that can be the end of a connecting edge.
  std::size_t count(int s) const {
    return s == 1 ? emitters_.size() : vertices_[static_cast<std::size_t>(s) - 2].size();
  }
  const EmitterPoint& emitter(std::size_t i) const { return emitters_[i]; }
  /// Vertex `i` in [0, count(s)) of those, s >= 2.
  const Vertex& at(int s, std::size_t i) const {
    return vertices_[static_cast<std::size_t>(s) - 2][i];
  }
  /// Asks for what a connection with it will read.
  void prefetch(int s, std::size_t i) const {
    const char* first = s == 1 ? reinterpret_cast<const char*>(&emitters_[i])
                               : reinterpret_cast<const char*>(&at(s, i));
    for (std::size_t k = 0; k < (s == 1 ? sizeof(EmitterPoint) : sizeof(Vertex)); k += 64) {
      _mm_prefetch(first + k, _MM_HINT_T0);
    }
  }

  /// Calls `use(end)` with vertex `i` of those: an EmitterEnd or a SurfaceEnd.
  template <class Guide, class Use>
  decltype(auto) with_end(int s, std::size_t i, const Guide& guide, Use&& use) const {
    if (s == 1) return use(EmitterEnd{emitters_[i]});
    return use(SurfaceEnd<Guide>{at(s, i), s - 1, Transport::importance, guide});
  }

 private:
  std::vector<Vertex>& of(int s) { return vertices_[static_cast<std::size_t>(s) - 2]; }

  std::size_t paths_;
  int longest_;
  std::vector<int> lengths_;
  std::vector<EmitterPoint> emitters_;
  std::vector<std::vector<Vertex>> vertices_;  // of s = 2 on
};

}  // namespace lacuna
