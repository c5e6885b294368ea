#pragma once

#include <immintrin.h>

#include <vector>

#include "renderer/path/light_batch.h"

namespace lacuna {

/// The light paths of an iteration that the eye paths of all pixels share: `paths` of them, each
/// with up to `longest` vertices. s counts the vertices from the light; s = 1 is on the emitter.
class LightVertices {
 public:
  /// `counts`: the sample counts with which Vertex::mis_partial of the paths was computed.
  LightVertices(std::size_t paths, int longest, const SampleCounts& counts = {})
      : paths_(paths),
        longest_(longest),
        counts_(counts),
        kept_(paths),
        vertices_(static_cast<std::size_t>(std::max(0, longest - 1))) {}

  std::size_t paths() const { return paths_; }
  int longest() const { return longest_; }
  const SampleCounts& counts() const { return counts_; }

  /// Stores the connectible vertices of path `i` of `batch` as path number `path`. Several threads
  /// may store different paths at once.
  void keep(std::size_t path, const LightBatch& batch, std::size_t i) {
    Path& p = kept_[path];
    if (std::min(batch.length(i), longest_) > 0) p.emitter = batch.emitter(i);
    batch.for_each_vertex(i, [&](std::size_t j, int index) {
      if (index >= longest_ || !batch.connectible(j, index)) return;
      p.vertices.push_back(batch.vertex(j, index));
      p.s.push_back(index + 1);
    });
  }

  /// Call once all paths are stored: gathers the vertices of each s, in the order of the paths.
  void arrange() {
    for (Path& p : kept_) {
      if (p.emitter) emitters_.push_back(*p.emitter);
      for (std::size_t k = 0; k < p.vertices.size(); ++k) {
        vertices_[static_cast<std::size_t>(p.s[k]) - 2].push_back(p.vertices[k]);
      }
      p = {};
    }
  }

  /// Number of connectible vertices with `s` vertices from the light.
  std::size_t count(int s) const {
    return s == 1 ? emitters_.size() : vertices_[static_cast<std::size_t>(s) - 2].size();
  }
  const EmitterPoint& emitter(std::size_t i) const { return emitters_[i]; }
  /// Connectible vertex `i` in [0, count(s)), s >= 2.
  const Vertex& at(int s, std::size_t i) const {
    return vertices_[static_cast<std::size_t>(s) - 2][i];
  }
  /// Prefetches what a connection to vertex `i` will read.
  void prefetch(int s, std::size_t i) const {
    const char* first = s == 1 ? reinterpret_cast<const char*>(&emitters_[i])
                               : reinterpret_cast<const char*>(&at(s, i));
    for (std::size_t k = 0; k < (s == 1 ? sizeof(EmitterPoint) : sizeof(Vertex)); k += 64) {
      _mm_prefetch(first + k, _MM_HINT_T0);
    }
  }

  /// Calls `use(endpoint)` for connectible vertex `i`: an EmitterEndpoint or a SurfaceEndpoint.
  template <class Use>
  decltype(auto) with_end(int s, std::size_t i, const Guide& guide, Use&& use) const {
    if (s == 1) return use(EmitterEndpoint{emitters_[i], guide});
    return use(SurfaceEndpoint{at(s, i), s - 1, Transport::importance, guide});
  }

 private:
  struct Path {
    std::optional<EmitterPoint> emitter;
    std::vector<Vertex> vertices;
    std::vector<int> s;  // of each, >= 2
  };

  std::size_t paths_;
  int longest_;
  SampleCounts counts_;
  std::vector<Path> kept_;
  std::vector<EmitterPoint> emitters_;
  std::vector<std::vector<Vertex>> vertices_;  // from s = 2 on
};

}  // namespace lacuna
