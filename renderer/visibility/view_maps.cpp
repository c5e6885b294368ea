#include "renderer/visibility/view_maps.h"

#include <fmt/format.h>

#include "renderer/core/free_memory.h"

namespace lacuna {

ViewMaps::ViewMaps(std::uint32_t leaves, int map_size, float extent)
    : map_{map_size}, nearness_(Nearness::within(extent)) {
  const std::size_t texels = std::size_t{leaves} * static_cast<std::size_t>(map_.texels());
  require_free(double(texels) * sizeof(std::uint16_t), [&] {
    return fmt::format(
        "view_maps: maps of 2 x {0} x {0} texels of {1} views; lower map_size, levels "
        "or light_paths",
        map_size, leaves);
  });
  texels_.resize(texels);
}

void ViewMaps::set(std::uint32_t leaf, std::span<const float> depths) {
  std::uint16_t* to = texels_.data() + std::size_t{leaf} * depths.size();
  for (std::size_t i = 0; i < depths.size(); ++i) {
    to[i] = nearness_.encode(depths[i]);
  }
}

float ViewMaps::nearness(std::uint32_t leaf, int texel) const {
  return Nearness::decode(texels_[std::size_t{leaf} * static_cast<std::size_t>(map_.texels()) +
                                  static_cast<std::size_t>(texel)]);
}

void trace_views(const RayCaster& rays, const ViewTree& views, const Paraboloid& map,
                 const ThreadPool& pool, const UseMap& use) {
  pool.for_each(static_cast<int>(views.leaf_count()), [&](int k) {
    const auto leaf = static_cast<std::uint32_t>(k);
    const V3f from = views.node(views.first_leaf() + leaf).centre;
    std::vector<float> depths(static_cast<std::size_t>(map.texels()),
                              std::numeric_limits<float>::infinity());
    for (int i = 0; i < map.texels(); ++i) {
      Hit hit;
      if (rays.intersect({from, map.direction(i)}, hit)) {
        depths[static_cast<std::size_t>(i)] = hit.t;
      }
    }
    use(leaf, depths);
  });
}

}  // namespace lacuna
