#pragma once

#include <span>
#include <vector>

#include "renderer/core/huge_pages.h"
#include "renderer/scene/scene.h"
#include "renderer/view_maps/many_views.h"
#include "renderer/view_maps/nearness.h"

namespace lacuna {

/// A map texel as a cone.
struct MapTexel {
  V3f direction;       ///< through its centre, unit
  float cosine, sine;  ///< of the angle between direction and corners
  bool reachable;      ///< Paraboloid::reachable()
};
/// The cones of all texels of a map.
std::vector<MapTexel> map_texels(const Paraboloid& map);

/// The complete maps of all leaves of a view tree, as half floats: a texel of 16 x 16 spans an
/// eighth of a right angle, so a distance is far less certain than its 11 bits. Memory is reused
/// for the next tree, so that the system clears its pages only once.
class ViewMaps {
 public:
  /// `extent`: the largest distance, scene units.
  ViewMaps(int map_size, float extent) : map_{map_size}, nearness_(Nearness::within(extent)) {}

  /// Allocates `leaves` maps; each must be set before it is read. Throws MemoryLimitError if there
  /// is not enough memory.
  void resize(std::uint32_t leaves);
  const Paraboloid& map() const { return map_; }
  /// Stores a map: the distance of each texel, or infinity. Different leaves may be set by several
  /// threads at once.
  void set(std::uint32_t leaf, std::span<const float> depths);
  /// scale() / distance; 0 if the texel is empty.
  float nearness(std::uint32_t leaf, int texel) const;
  float scale() const { return nearness_.scale; }
  /// What nearness() returns of a texel of this distance.
  float coded(float distance) const { return Nearness::decode(nearness_.encode(distance)); }
  /// Allocated memory: that of the largest number of maps so far.
  std::size_t bytes() const { return texels_.size() * sizeof(texels_[0]); }

 private:
  Paraboloid map_;
  Nearness nearness_;
  HugeVector<std::uint16_t> texels_;  // of the largest number of maps so far
};

/// Like render_views(), but traces a ray from the centre of each leaf's views through each texel
/// that may be visible from one of them: one map per view. `packets`: eight neighbouring rays at
/// once. Returns the number of rays.
std::uint64_t trace_views(const RayCaster& rays, const ViewTree& views,
                          std::span<const MapTexel> texels, bool packets, const ThreadPool& pool,
                          const UseMap& use);

}  // namespace lacuna
