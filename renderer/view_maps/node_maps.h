#pragma once

#include <span>
#include <vector>

#include "analysis/artefacts/codec.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Cube maps of depth around some points (Noel 2015, 8.3). 16 bits are sufficient: depth is
/// uncertain by half a texel's width, at least 1/1024 of the distance, and a half float has a
/// precision of 1/2048.
struct NodeMaps {
  static constexpr int faces = 6;
  /// Extra texels, so that eight can be read from any texel.
  static constexpr std::size_t margin = 8;

  int size = 0;     ///< texels along the side of a face
  float scale = 0;  ///< a texel is scale / depth; 0: the ray hits nothing
  /// Half floats. Point n, face f = 2 axis + (1 for the negative direction), row j along axis + 2,
  /// column i along axis + 1 (both modulo 3) is at ((6 n + f) size + j) size + i; `margin` more
  /// follow. Depth is measured along the face's axis.
  std::vector<std::uint16_t> texels;

  std::size_t points() const {
    const std::size_t one = texels_of_point();
    return one == 0 ? 0 : (texels.size() - margin) / one;
  }
  std::size_t texels_of_point() const {
    return std::size_t{faces} * static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
  }
};

/// Traces a ray through the centre of every texel. `size` in [8, 1024]. Throws MemoryLimitError if
/// the maps need more than `byte_limit` bytes.
NodeMaps trace_node_maps(const Scene& scene, std::span<const V3f> points, int size,
                         const ThreadPool& pool, std::uint64_t byte_limit);

/// The visibility from the centre of one cube map. Compares each texel around a direction with the
/// depth of a plane and averages the results (percentage-closer filtering, Reeves et al. 1987):
/// fractions in [0, 1].
class NodeView {
 public:
  /// `point`: the centre of map `index` of `maps`. `filter`: side of the filter's square, texels,
  /// in [1, 7].
  NodeView(const NodeMaps& maps, std::size_t index, const V3f& point, int filter)
      : maps_(&maps), index_(index), point_(point), filter_(filter) {}

  const V3f& point() const { return point_; }
  /// The visible fraction of the surface around `x` with unit normal `n`, on the side of n.
  float visible_fraction(const V3f& x, const V3f& n) const;
  /// The same for `x` in empty space, with the plane perpendicular to the direction to it.
  float visible_fraction(const V3f& x) const;
  /// The fraction of the directions around unit `w` that hit nothing.
  float open(const V3f& w) const;

 private:
  NodeView() = default;

  const NodeMaps* maps_;
  std::size_t index_;
  V3f point_;
  int filter_;
};

template <>
struct Codec<NodeMaps> {
  static void write(ArtefactWriter& out, const NodeMaps& maps);
  static NodeMaps read(ArtefactReader& in);
};

}  // namespace lacuna
