#include "renderer/view_maps/view_rendering.h"

#include <bit>
#include <limits>

namespace lacuna {

ManyViewsCounts& ManyViewsCounts::operator+=(const ManyViewsCounts& o) {
  pairs += o.pairs;
  culled += o.culled;
  splats += o.splats;
  shared += o.shared;
  sharing += o.sharing;
  large += o.large;
  filled += o.filled;
  for (std::size_t i = 0; i < generations.size(); ++i) generations[i] += o.generations[i];
  queue_bytes = std::max(queue_bytes, o.queue_bytes);
  unfused_bytes = std::max(unfused_bytes, o.unfused_bytes);
  fusion_seconds += o.fusion_seconds;
  return *this;
}

namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

/// The boxes of the leaves below eight nodes (SceneNodes::Node::shape), in the grid.
struct Boxes8 {
  Float8x3 centre;  ///< relative to the centres of the nodes' cubes
  Float8x3 half;    ///< half the side lengths

  Boxes8(Int8 shape, float half_side) {
    const auto axis = [&](int bit, Float8& middle, Float8& size) {
      const Float8 from = to_float((shape >> bit) & Int8(15));
      const Float8 to = to_float((shape >> (bit + 4)) & Int8(15));
      middle = (from + to - Float8(15.0F)) * Float8(half_side / 16);
      size = (to - from + Float8(1.0F)) * Float8(half_side / 16);
    };
    axis(8, centre.x, half.x);
    axis(16, centre.y, half.y);
    axis(24, centre.z, half.z);
  }
};

}  // namespace

/// A view node in the grid of the scene's nodes.
struct ViewRendering::Visit {
  V3f centre;
  float radius;
  V3f n;
  float cosine, sine2;  // of the half angle of the normals' cone; square of its sine
  /// For each coordinate k, the largest |n'_k| over all n' in the normals' cone.
  V3f widest;
  float width;  // largest distance of views from the centre along any n'
  bool everywhere;
  bool leaf, several;  // `several`: of more than one view
  int depth;           // number of forks above
};

ViewRendering::ViewRendering(const SceneNodes& scene, const ViewTree& views,
                             const ManyViewsSettings& settings)
    : scene_(scene), views_(views), settings_(settings), map_{settings.map_size} {
  const std::size_t floats = (texels() + 7) / 8 * 8 + 8;  // see fill_cap()
  for (std::vector<float>* v : {&x_, &y_, &z_}) v->assign(floats, 0.0F);
  for (int i = 0; i < map_.texels(); ++i) {
    const V3f w = map_.direction(i);
    x_[static_cast<std::size_t>(i)] = w.x;
    y_[static_cast<std::size_t>(i)] = w.y;
    z_[static_cast<std::size_t>(i)] = w.z;
  }
  const std::vector<Octree::Node>& nodes = views.tree().nodes;
  depth_.assign(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::uint32_t c = 0; c < nodes[i].children; ++c) {
      depth_[nodes[i].first_child + c] =
          static_cast<std::uint8_t>(depth_[i] + (nodes[i].children > 1 ? 1 : 0));
    }
  }
}

std::uint32_t ViewRendering::fork(std::uint32_t view) const {
  const std::vector<Octree::Node>& nodes = views_.tree().nodes;
  while (nodes[view].children == 1) view = nodes[view].first_child;
  return view;
}

inline ViewRendering::Visit ViewRendering::visit(std::uint32_t view) const {
  const ViewTree::Node& node = views_.node(view);
  const auto unit = static_cast<float>(scene_.unit());
  Visit v{.centre = scene_.to_grid(node.centre),
          .radius = node.radius / unit,
          .n = node.n,
          .cosine = node.sine,
          .sine2 = node.cosine * node.cosine,
          .widest = V3f(1.0F),
          .width = node.radius / unit,
          .everywhere = node.cosine <= -1,
          .leaf = is_leaf(view),
          .several = node.views > 1,
          .depth = depth(view)};
  if (v.everywhere || !settings_.boxes) return v;
  for (int k = 0; k < 3; ++k) {
    const float n = std::min(1.0F, std::abs(v.n[k]));
    // cos(angle to the axis - half angle of the cone); 1 inside the cone.
    if (n < v.cosine) v.widest[k] = n * v.cosine - std::sqrt(1 - n * n) * node.cosine;
  }
  v.width = std::min(v.width, v.widest.dot(node.half) / unit);
  return v;
}

/// Whether no view below sees any part of a scene node: for no n' in the cone of their normals, no
/// position x of a view and no point p of the node is n' (p - x) > 0. p - x is the difference of
/// both centres plus the deviations from them, bounded by the boxes or by the spheres (Fig. 4; the
/// angle of the cone that no view sees is below a right angle here). The difference d lies beyond
/// all planes if |d| cos(angle to n - half angle of the cone) is negative.
inline unsigned ViewRendering::culled(const Visit& v, int level, const NodeList::Eight& e,
                                      const Float8x3& d, Float8 length2) const {
  Float8x3 centre = d;
  Float8 off(v.width + scene_.radius(level));
  if (settings_.boxes) {
    const Boxes8 box(e.shape, scene_.half_side(level));
    centre = d + box.centre;
    length2 = lacuna::length2(centre);
    off = dot(box.half, Float8x3{v.widest.x, v.widest.y, v.widest.z}) + Float8(v.width);
  }
  constexpr float rounding = 1 + 1e-5F, margin = 1.0F / 256;  // in units of half a leaf's side
  const Float8 along = dot(centre, Float8x3{v.n.x, v.n.y, v.n.z});
  const Float8 beyond =
      Float8(0.0F) - along * Float8(v.cosine) - (off * Float8(rounding) + Float8(margin));
  const Float8 across2 = length2 - along * along;
  return movemask(beyond > Float8(0.0F) && beyond * beyond > across2 * Float8(v.sine2));
}

inline void ViewRendering::render_level(const Visit& v, int level, const NodeList& nodes,
                                        std::span<float> depths, NodeList& later, Scratch& scratch,
                                        ManyViewsCounts& counts) const {
  if (nodes.empty()) return;
  const bool scene_leaves = level == scene_.levels();
  const float radius = scene_.radius(level);
  const bool cull = settings_.cull && !v.everywhere;
  // Fig. 6: the scene node is smaller than `node_texels` for all views below, and none of these is
  // further from their centre than the node's size, so it covers the same texel in all of them.
  const bool can_share = (settings_.merge || scene_leaves) && v.radius <= radius;
  const float size = static_cast<float>(map_.size) / settings_.node_texels;
  const bool defer = !v.leaf && (scene_leaves || radius / 2 < v.radius);  // Fig. 8
  NodeList& rest = defer ? later : scratch.split;
  rest.make_room(nodes.size());
  const std::size_t before = rest.size();
  if (scratch.texels.size() < nodes.size() + 8) {
    scratch.texels.resize(2 * nodes.size() + 8);
    scratch.distances.resize(2 * nodes.size() + 8);
  }
  std::size_t splats = 0, same_texel = 0, out_of_sight = 0;
  for (std::size_t i = 0; i < nodes.size(); i += 8) {
    const NodeList::Eight e = nodes.eight(i);
    unsigned lanes = nodes.size() - i < 8 ? (1U << (nodes.size() - i)) - 1 : 0xff;
    const Float8x3 d{e.x - Float8(v.centre.x), e.y - Float8(v.centre.y), e.z - Float8(v.centre.z)};
    const Float8 squared = length2(d);
    if (cull) {
      const unsigned out = lanes & culled(v, level, e, d, squared);
      out_of_sight += static_cast<std::size_t>(std::popcount(out));
      lanes &= ~out;
    }
    if (can_share) {
      const Float8 distance = sqrt(squared);
      const Float8 nearest = distance - Float8(v.radius);
      // 2 radius / nearest Paraboloid::stretch() < node_texels, without a division
      const Float8 bound = nearest * (distance + abs(d.x));
      const unsigned same =
          lanes & movemask(nearest > Float8(radius) && bound > Float8(radius * size) * distance);
      lanes &= ~same;
      same_texel += static_cast<std::size_t>(std::popcount(same));
      // A node is placed at the middle of its leaves: the middle of a cube that a wall crosses near
      // one side is up to the cube's radius in front of the wall.
      const Float8x3 middle = d + Boxes8(e.shape, scene_.half_side(level)).centre;
      const Float8 depth = sqrt(length2(middle));
      const Paraboloid::TexelCoord8 coords = map_.coords(middle, depth);
      const unsigned shown =
          settings_.cover > 0
              ? same & movemask(map_.covers_middle(coords, radius * settings_.cover))
              : same;
      const Int8 order = to_front(shown);
      permute(map_.texel(coords), order).store_unaligned(&scratch.texels[splats]);
      permute(depth, order).store_unaligned(&scratch.distances[splats]);
      splats += static_cast<std::size_t>(std::popcount(shown));
    }
    rest.append(e, lanes);
  }
  for (std::size_t i = 0; i < splats; ++i) {
    float& depth = depths[scratch.texels[i]];
    depth = std::min(depth, scratch.distances[i]);
  }
  const std::size_t left = rest.size() - before;
  counts.pairs += nodes.size();
  counts.generations[static_cast<std::size_t>(level + v.depth)] += nodes.size();
  counts.culled += out_of_sight;
  counts.splats += same_texel;
  if (v.leaf && scene_leaves) {
    fill(v, rest, before, depths, scratch, counts);
    rest.resize(before);
    counts.large += left;
    counts.shared += v.several ? left : 0;
    counts.splats += left;
  }
}

void ViewRendering::render(std::uint32_t view, const NodeLevels& waiting, std::span<float> depths,
                           NodeLevels& later, Scratch& scratch, ManyViewsCounts& counts) const {
  const Visit v = visit(view);
  const std::uint64_t splats = counts.splats;
  scratch.fresh[0].clear();
  for (int level = 0; level <= scene_.levels(); ++level) {
    const auto l = static_cast<std::size_t>(level);
    NodeList& below = scratch.fresh[(l + 1) % 2];
    later[l].clear();
    scratch.split.clear();
    render_level(v, level, waiting[l], depths, later[l], scratch, counts);
    render_level(v, level, scratch.fresh[l % 2], depths, later[l], scratch, counts);
    below.clear();
    if (!scratch.split.empty()) scene_.append_children(scratch.split, level, below);
  }
  counts.sharing += (counts.splats - splats) * views_.node(view).views;
}

void ViewRendering::render_once(std::uint32_t view, int level, const NodeList& nodes,
                                std::span<float> depths, NodeList& later, Scratch& scratch,
                                ManyViewsCounts& counts) const {
  const std::uint64_t splats = counts.splats;
  render_level(visit(view), level, nodes, depths, later, scratch, counts);
  counts.sharing += (counts.splats - splats) * views_.node(view).views;
}

/// For leaves from index `first`, fills all texels whose centre the sphere covers; with cover 0,
/// also the texel of its centre. With `mips`, as published (3.2.4): by MipSplats. Skips a leaf
/// whose cube contains the view: it would occlude half of all directions, and the position of its
/// surface in the cube is unknown.
void ViewRendering::fill(const Visit& v, const NodeList& nodes, std::size_t first,
                         std::span<float> depths, Scratch& scratch, ManyViewsCounts& counts) const {
  if (settings_.mips && !scratch.mips) scratch.mips.emplace(map_);
  const float whole = scene_.radius(scene_.levels());
  const float radius = settings_.cover > 0 ? settings_.cover * whole : whole;
  const float half_a_leaf = scene_.half_side(scene_.levels());
  for (std::size_t i = first; i < nodes.size(); ++i) {
    const V3f d = V3f(nodes.x[i], nodes.y[i], nodes.z[i]) - v.centre;
    if (std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < half_a_leaf) continue;
    const float distance = d.length();
    if (settings_.mips) {
      const float width = 2 * radius / distance * map_.stretch(std::abs(d.x) / distance);
      scratch.mips->splat(map_.coord(d), width, distance, depths);
      ++counts.filled;
      continue;
    }
    if (settings_.cover == 0) {
      float& depth = depths[static_cast<std::size_t>(map_.texel(d))];
      depth = std::min(depth, distance);
    }
    const float sine = distance > radius ? radius / distance : 1;
    const float cosine = std::sqrt(std::max(0.0F, 1 - sine * sine));
    const V3f w = d / distance;
    for (int half = 0; half < 2; ++half) {
      const Paraboloid::Rectangle r = map_.cap(half, w, cosine, sine);
      fill_cap(half, r, w, cosine, distance, depths);
      counts.filled += static_cast<std::uint64_t>((r.v_end - r.v_first) * (r.u_end - r.u_first));
    }
  }
  if (settings_.mips) counts.filled += scratch.mips->push(depths);
}

/// Processes eight texels at a time, including some beside the rectangle, which lie outside the
/// cap.
inline void ViewRendering::fill_cap(int half, const Paraboloid::Rectangle& r, const V3f& w,
                                    float cosine, float distance, std::span<float> depths) const {
  const Float8x3 axis{w.x, w.y, w.z};
  for (int v = r.v_first; v < r.v_end; ++v) {
    for (int u = r.u_first; u < r.u_end; u += 8) {
      const auto at = static_cast<std::size_t>(map_.index(half, u, v));
      const auto depth = Float8::load_unaligned(&depths[at]);
      const Float8x3 to{Float8::load_unaligned(&x_[at]), Float8::load_unaligned(&y_[at]),
                        Float8::load_unaligned(&z_[at])};
      const Mask8 covered = dot(to, axis) >= Float8(cosine);
      select(covered, min(depth, Float8(distance)), depth).store_unaligned(&depths[at]);
    }
  }
}

std::vector<V3f> ViewRendering::directions() const {
  std::vector<V3f> all(texels());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = {x_[i], y_[i], z_[i]};
  return all;
}

void ViewRendering::hand_down(std::uint32_t parent, std::span<const float> from,
                              std::uint32_t child, std::span<float> to) const {
  const V3f step =
      scene_.to_grid(views_.node(parent).centre) - scene_.to_grid(views_.node(child).centre);
  const Float8x3 s{step.x, step.y, step.z};
  for (std::size_t i = 0; i < from.size(); i += 8) {
    const auto depth = Float8::load_unaligned(&from[i]);
    const Float8x3 w{Float8::load_unaligned(&x_[i]), Float8::load_unaligned(&y_[i]),
                     Float8::load_unaligned(&z_[i])};
    const Float8 moved = sqrt(length2(s + w * depth));
    select(Float8(nothing) > depth, moved, Float8(nothing)).store_unaligned(&to[i]);
  }
}

void ViewRendering::to_scene_units(std::span<const float> depths, std::vector<float>& to) const {
  const auto unit = static_cast<float>(scene_.unit());
  to.resize(depths.size());
  for (std::size_t i = 0; i < depths.size(); ++i) to[i] = depths[i] * unit;
}

}  // namespace lacuna
