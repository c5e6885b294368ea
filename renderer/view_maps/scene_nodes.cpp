#include "renderer/view_maps/scene_nodes.h"

#include <algorithm>
#include <bit>

#include "base/parallel/for_each_chunked.h"

namespace lacuna {

namespace {

constexpr std::uint32_t whole_cube =
    0xf0f0f000;  // first sixteenth 0, last sixteenth 15 on each axis

std::uint32_t low(std::uint32_t shape, int axis) { return shape >> (8 + 8 * axis) & 15; }
std::uint32_t high(std::uint32_t shape, int axis) { return shape >> (12 + 8 * axis) & 15; }

/// The shape of a node from the shapes of its children, which are ordered by octant.
std::uint32_t shape_of(std::uint32_t octants, const SceneNodes::Node* child) {
  std::array<std::uint32_t, 3> from{15, 15, 15}, to{0, 0, 0};
  for (unsigned o = 0; o < 8; ++o) {
    if ((octants >> o & 1) == 0) continue;
    const std::uint32_t shape = child++->shape;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      const std::uint32_t second_half = (o >> axis & 1) * 16;
      from[k] = std::min(from[k], (second_half + low(shape, axis)) / 2);
      to[k] = std::max(to[k], (second_half + high(shape, axis)) / 2);
    }
  }
  std::uint32_t shape = octants;
  for (unsigned k = 0; k < 3; ++k) shape |= from[k] << (8 + 8 * k) | to[k] << (12 + 8 * k);
  return shape;
}

Float8x3 octant_signs() {
  return {_mm256_setr_ps(-1, 1, -1, 1, -1, 1, -1, 1), _mm256_setr_ps(-1, -1, 1, 1, -1, -1, 1, 1),
          _mm256_setr_ps(-1, -1, -1, -1, 1, 1, 1, 1)};
}

}  // namespace

SceneNodes::SceneNodes(const Octree& scene, const ThreadPool& pool)
    : nodes_(scene.nodes.size() + 8),
      corner_(scene.corner),
      unit_(std::ldexp(scene.side, -scene.levels() - 1)),
      levels_(scene.levels()),
      leaves_(scene.leaves().size()) {
  constexpr std::size_t at_once = 1 << 16;
  for (auto level = static_cast<std::size_t>(levels_) + 1; level-- > 0;) {
    const std::size_t first = scene.first[level], end = scene.first[level + 1];
    for_each_chunked(pool, end - first, at_once, [&](std::size_t i) {
      const Octree::Node& node = scene.nodes[first + i];
      nodes_[first + i] = {
          node.first_child,
          node.children == 0 ? whole_cube : shape_of(node.octants, &nodes_[node.first_child])};
    });
  }
}

void SceneNodes::append_root(NodeList& to) const {
  to.make_room(1);
  const Float8 middle(half_side(0));
  to.store({middle, middle, middle, Int8(0), Int8(static_cast<int>(nodes_[0].shape))}, 1);
}

void SceneNodes::append_children(const NodeList& from, int level, NodeList& to) const {
  to.make_room(8 * from.size());
  const Float8x3 step = octant_signs() * Float8(half_side(level + 1));
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::uint32_t first = nodes_[from.node[i]].first_child;
    const unsigned octants = from.shape[i] & 0xff;
    const Int8 order = to_front(octants);
    // Children are contiguous.
    const auto* words = &nodes_[first].first_child;
    const Float8 a = as_float(Int8::load_unaligned(words));
    const Float8 b = as_float(Int8::load_unaligned(words + 8));
    const Float8 shapes = _mm256_shuffle_ps(a.v, b.v, 0xdd);  // of 0, 1, 4, 5, 2, 3, 6, 7
    const Int8 in_order = _mm256_permute4x64_epi64(as_int(shapes).v, 0xd8);
    to.store(
        {Float8(from.x[i]) + permute(step.x, order), Float8(from.y[i]) + permute(step.y, order),
         Float8(from.z[i]) + permute(step.z, order), Int8(static_cast<int>(first)) + lane_numbers(),
         in_order},
        static_cast<std::size_t>(std::popcount(octants)));
  }
}

}  // namespace lacuna
