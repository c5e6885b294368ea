#pragma once

#include <span>
#include <vector>

#include "analysis/artefacts/codec.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// How far points are seen in all directions from some places: a cube map around each (Noel 2015,
/// 8.3). Sixteen bits are enough: half a texel's width, which answers are uncertain by anyway, is
/// 1/1024 of the distance or more, and a half float's last place at most 1/2048.
struct NodeMaps {
  static constexpr int faces = 6;
  /// A row of eight may be read from any texel on.
  static constexpr std::size_t margin = 8;

  int size = 0;     ///< texels along the side of a face
  float scale = 0;  ///< texels hold scale / depth, and 0 where nothing is met
  /// Half floats: of place n, face f = 2 axis + (1: towards its negative end), row j along the
  /// second next axis and column i along the next one at ((6 n + f) size + j) size + i; `margin`
  /// more follow. Depth is that along the face's axis.
  std::vector<std::uint16_t> texels;

  std::size_t places() const {
    const std::size_t one = texels_of_place();
    return one == 0 ? 0 : (texels.size() - margin) / one;
  }
  std::size_t texels_of_place() const {
    return std::size_t{faces} * static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  }
};

/// Sends a ray through the middle of every texel. `size` in [8, 1024]. Throws MemoryLimitError if
/// the maps would take more than `byte_limit` bytes.
NodeMaps trace_node_maps(const Scene& scene, std::span<const V3f> places, int size,
                         const ThreadPool& pool, std::uint64_t byte_limit);

/// What one place sees.
class NodeView {
 public:
  /// `place`: of number `index` in `maps`. The filter's square has `filter` texels along each side,
  /// in [1, 7].
  NodeView(const NodeMaps& maps, std::size_t index, const V3f& place, int filter)
      : maps_(&maps), index_(index), place_(place), filter_(filter) {}

  /// How much of the surface through `x` with unit normal `n` is seen around x on the side of n, as
  /// a share in [0, 1]: the map around the direction of x, each texel compared with the depth of
  /// the surface's plane there, averaged (percentage-closer filtering, Reeves et al. 1987).
  float seen(const V3f& x, const V3f& n) const;

 private:
  NodeView() = default;

  const NodeMaps* maps_;
  std::size_t index_;
  V3f place_;
  int filter_;
};

template <>
struct Codec<NodeMaps> {
  static void write(ArtefactWriter& out, const NodeMaps& maps);
  static NodeMaps read(ArtefactReader& in);
};

}  // namespace lacuna
