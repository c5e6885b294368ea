#include "renderer/many_lights/cube_culling.h"

#include <fmt/format.h>

#include <atomic>
#include <bit>

#include "renderer/core/free_memory.h"

namespace lacuna {

CubeCulling::CubeCulling(const VplSet& lights, const Octree& scene, float cutoff,
                         const ThreadPool& pool)
    : scene_(scene), cutoff_(cutoff) {
  std::vector<View> views;
  std::vector<std::uint32_t> number, infinite;  // of each view: its light
  std::uint32_t n = 0;
  for (std::size_t b = 0; b < lights.blocks(); ++b) {
    for (int i = 0; i < lights.count(b); ++i, ++n) {
      const VplGeometry light = lights.geometry(b, i);
      (light.infinite ? infinite : number).push_back(n);
      // Only diffuse lights surely illuminate no point behind them.
      const bool one_sided = lights.diffuse(b) != nullptr;
      if (!light.infinite) views.push_back({light.x, one_sided ? light.n : V3f(0.0F)});
    }
  }
  const double side = scene.empty() ? 1 : scene.side;
  views_.emplace(views, levels, scene.corner, side, ViewTree::Split::position);
  const std::size_t leaves = views.empty() ? 0 : views_->leaf_count();
  first_.assign(leaves + 2, 0);
  for (std::size_t v = 0; v < views.size(); ++v) ++first_[views_->leaf_of(v) + 1];
  for (std::size_t l = 0; l < leaves; ++l) first_[l + 1] += first_[l];
  first_[leaves + 1] = n;
  lights_.resize(n);
  std::vector<std::uint32_t> next = first_;
  for (std::size_t v = 0; v < views.size(); ++v) lights_[next[views_->leaf_of(v)]++] = number[v];
  std::copy(infinite.begin(), infinite.end(), lights_.begin() + next[leaves]);

  words_ = leaves / 64 + 1;
  require_free(double(scene.leaves().size()) * double(words_) * sizeof(std::uint64_t), [&] {
    return fmt::format("gather: {} leaves with lights for each of {} cubes; use cull_for points",
                       leaves, scene.leaves().size());
  });
  left_.assign(scene.leaves().size() * words_, 0);
  for (std::size_t c = 0; c < scene.leaves().size(); ++c) {
    left_[c * words_ + leaves / 64] |= std::uint64_t{1} << leaves % 64;  // lights at infinity
  }
  if (views.empty() || scene.empty()) return;
  // The nodes of one level separately, as in the paper's passes (4.2).
  const auto level = static_cast<std::size_t>(std::min(2, scene.levels()));
  std::atomic<std::uint64_t> pairs = 0;
  pool.for_each(static_cast<int>(scene.first[level + 1] - scene.first[level]), [&](int k) {
    std::uint64_t own = 0;
    cull_below(scene.first[level] + static_cast<std::uint32_t>(k), {0}, own);
    pairs += own;
  });
  pairs_ = pairs;
}

void CubeCulling::cull_below(std::uint32_t scene_node, std::vector<std::uint32_t> waiting,
                             std::uint64_t& pairs) {
  const Octree::Node& s = scene_.nodes[scene_node];
  const std::uint32_t first_cube = scene_.first[scene_.first.size() - 2];
  std::vector<std::uint32_t> later;
  while (!waiting.empty()) {
    const std::uint32_t view_node = waiting.back();
    waiting.pop_back();
    ++pairs;
    if (culled(scene_node, view_node)) continue;
    const Octree::Node& v = views_->tree().nodes[view_node];
    const bool smaller =
        s.children == 0 || scene_.radius(s.level + 1) < views_->node(view_node).radius;
    if (v.children > 0 && smaller) {  // Fig. 8
      for (std::uint32_t c = 0; c < v.children; ++c) waiting.push_back(v.first_child + c);
    } else if (s.children > 0) {
      later.push_back(view_node);
    } else {
      const std::uint32_t leaf = view_node - views_->first_leaf();
      left_[(scene_node - first_cube) * words_ + leaf / 64] |= std::uint64_t{1} << leaf % 64;
    }
  }
  for (std::uint32_t c = 0; c < s.children && !later.empty(); ++c) {
    cull_below(s.first_child + c, later, pairs);
  }
}

bool CubeCulling::culled(std::uint32_t scene_node, std::uint32_t view_node) const {
  const Octree::Node& s = scene_.nodes[scene_node];
  const ViewTree::Node& v = views_->node(view_node);
  constexpr float rounding = 1 + 1e-5F;
  const V3f d = V3f(s.centre) - v.centre;
  const float apart = (scene_.radius(s.level) + v.radius) * rounding;
  const float distance = d.length();
  if (cutoff_ > 0 && distance > cutoff_ * rounding + apart) return true;
  if (v.cosine <= -1) return false;
  // The directions that no view sees are the cone around -n whose half angle is pi minus that of
  // v. The distance of d from its surface, positive inside:
  const float along = d.dot(v.n);
  const float across = std::sqrt(std::max(0.0F, distance * distance - along * along));
  return across * v.cosine - along * v.sine > apart + distance * (rounding - 1);
}

double CubeCulling::culled() const {
  double kept = 0;
  for (const std::uint64_t bits : left_) kept += std::popcount(bits);
  return left_.empty() ? 0 : 1 - kept / (double(scene_.leaves().size()) * double(leaves()));
}

std::optional<std::span<const std::uint64_t>> CubeCulling::left(const V3f& x) const {
  if (scene_.empty()) return {};
  const V3d at = (V3d(x) - scene_.corner) * (2 / scene_.side);
  std::uint32_t node = 0;
  // The cube of a node has the corner `low` and, in halves of the root's, the side `side`.
  V3d low(0.0);
  double side = 2;
  for (int level = 0; level < scene_.levels(); ++level) {
    side /= 2;
    int octant = 0;
    for (int k = 0; k < 3; ++k) {
      if (at[k] < low[k] + side) continue;
      octant |= 1 << k;
      low[k] += side;
    }
    const Octree::Node& n = scene_.nodes[node];
    if ((n.octants >> octant & 1) == 0) return {};
    const unsigned before = n.octants & ((1U << octant) - 1);
    node = n.first_child + static_cast<std::uint32_t>(std::popcount(before));
  }
  const std::uint32_t cube = node - scene_.first[scene_.first.size() - 2];
  return std::span(left_).subspan(cube * words_, words_);
}

}  // namespace lacuna
