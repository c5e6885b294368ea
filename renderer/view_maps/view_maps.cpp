#include "renderer/view_maps/view_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "renderer/core/free_memory.h"

namespace lacuna {

void ViewMaps::resize(std::uint32_t leaves) {
  const std::size_t texels = std::size_t{leaves} * static_cast<std::size_t>(map_.texels());
  if (texels <= texels_.size()) return;
  if (texels > texels_.capacity()) texels_ = {};  // frees memory before allocating more
  require_free(double(texels - texels_.size()) * sizeof(std::uint16_t), [&] {
    return fmt::format(
        "view_maps: maps of 2 x {0} x {0} texels of {1} views; lower map_size, levels "
        "or light_paths",
        map_.size, leaves);
  });
  // The number of lights varies slightly between iterations. Capacity beyond `texels` takes memory
  // only when it is used, and no more address space than require_free() leaves.
  if (texels > texels_.capacity()) texels_.reserve(texels + texels / 16);
  texels_.resize(texels);
}

void ViewMaps::set(std::uint32_t leaf, std::span<const float> depths) {
  std::uint16_t* to = texels_.data() + std::size_t{leaf} * depths.size();
  nearness_.encode(depths, to);
}

float ViewMaps::nearness(std::uint32_t leaf, int texel) const {
  return Nearness::decode(texels_[std::size_t{leaf} * static_cast<std::size_t>(map_.texels()) +
                                  static_cast<std::size_t>(texel)]);
}

std::vector<MapTexel> map_texels(const Paraboloid& map) {
  std::vector<MapTexel> texels;
  for (int i = 0; i < map.texels(); ++i) {
    const V3f w = map.direction(i);
    // Half the diagonal of a texel, as an angle.
    const float half = std::sqrt(0.5F) / map.stretch(std::abs(w.x));
    texels.push_back({w, std::cos(half), std::sin(half), map.reachable(i)});
  }
  return texels;
}

namespace {

/// Whether the texel is outside all fields of view: the angle between its direction and the axis of
/// the views' cone exceeds the sum of both half angles.
bool out_of_view(const ViewTree::Node& v, const MapTexel& t) {
  const bool narrow = v.sine * t.cosine + v.cosine * t.sine > 0;  // the sum is below pi
  return narrow && v.n.dot(t.direction) < v.cosine * t.cosine - v.sine * t.sine;
}

}  // namespace

std::uint64_t trace_views(const RayCaster& rays, const ViewTree& views,
                          std::span<const MapTexel> texels, bool packets, const ThreadPool& pool,
                          const UseMap& use) {
  // Each packet is a block of 4 x 2 texels.
  std::vector<std::size_t> order(texels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(double(texels.size()) / 2)));
  std::stable_sort(order.begin(), order.end(), [side](std::size_t a, std::size_t b) {
    const auto block = [side](std::size_t i) { return std::pair(i / side / 2, i % side / 4); };
    return block(a) < block(b);
  });
  std::atomic<std::uint64_t> traced = 0;
  pool.for_each(static_cast<int>(views.leaf_count()), [&](int k) {
    const auto leaf = static_cast<std::uint32_t>(k);
    const ViewTree::Node& v = views.node(views.first_leaf() + leaf);
    std::vector<Ray> own;
    std::vector<std::size_t> asked;
    for (const std::size_t i : order) {
      if (!texels[i].reachable || out_of_view(v, texels[i])) continue;
      own.push_back({v.centre, texels[i].direction});
      asked.push_back(i);
    }
    std::vector<Hit> hits(own.size());
    std::vector<std::uint8_t> hit(own.size());
    if (packets) {
      rays.intersect(own, hits, hit);
    } else {
      for (std::size_t i = 0; i < own.size(); ++i) hit[i] = rays.intersect(own[i], hits[i]) ? 1 : 0;
    }
    std::vector<float> depths(texels.size(), std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (hit[i] != 0) depths[asked[i]] = hits[i].t;
    }
    traced += own.size();
    use(leaf, depths);
  });
  return traced;
}

}  // namespace lacuna
