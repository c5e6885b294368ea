#include "renderer/view_maps/view_rendering.h"

#include <bit>

#include "analysis/geometry/bits.h"

namespace lacuna {

ManyViewsCounts& ManyViewsCounts::operator+=(const ManyViewsCounts& o) {
  pairs += o.pairs;
  culled += o.culled;
  splats += o.splats;
  sharing += o.sharing;
  large += o.large;
  for (std::size_t i = 0; i < generations.size(); ++i) generations[i] += o.generations[i];
  queue_bytes = std::max(queue_bytes, o.queue_bytes);
  unfused_bytes = std::max(unfused_bytes, o.unfused_bytes);
  fusion_seconds += o.fusion_seconds;
  return *this;
}

/// Siblings as a view node sees them, one for each octant; some are not there.
struct ViewRendering::Eight {
  Float8x3 d;       // from the view node's centre to theirs
  Float8 distance;  // the length of that
  float radius;     // of their spheres
  int level;
  unsigned there;             // bit i: octant i is
  std::uint32_t first_child;  // of their parent
  unsigned octants;           // of all its children

  std::uint32_t node(int lane) const {
    return first_child + static_cast<std::uint32_t>(std::popcount(octants & ((1U << lane) - 1)));
  }
};

namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();

Float8x3 octant_signs() {
  return {_mm256_setr_ps(-1, 1, -1, 1, -1, 1, -1, 1), _mm256_setr_ps(-1, -1, 1, 1, -1, -1, 1, 1),
          _mm256_setr_ps(-1, -1, -1, -1, 1, 1, 1, 1)};
}

/// Fig. 4: no view below sees anything of a sphere. The region that none of them sees is a cone;
/// the spheres of both nodes must fit between its rim and the scene node's centre.
unsigned outside(const ViewTree::Node& v, const Float8x3& d, Float8 distance, float radius) {
  if (v.cosine <= -1) return 0;
  const Float8 cosine(v.cosine), sine(v.sine);
  const Float8 along = dot(d, Float8x3{v.n.x, v.n.y, v.n.z});
  const Mask8 unseen = cosine * distance > along;  // alpha > psi, without a division
  if (!any(unseen)) return 0;
  // |d| sin(alpha - psi), the distance to the rim, or that to the apex where it is nearer.
  const Float8 across = sqrt(max(Float8(0.0F), distance * distance - along * along));
  const Mask8 beyond = Float8(0.0F) > along * cosine + across * sine;
  const Float8 to_rim = select(beyond, distance, across * cosine - along * sine);
  return movemask(unseen && to_rim > Float8((radius + v.radius) * (1 + 1e-5F)));
}

/// Fig. 6: a scene node shows less than `node_texels` to all views below, and none of them lies
/// further from their centre than it is large: so it fills the same texel in all of them. `size`:
/// of the map, over `node_texels`.
unsigned same_texel(float size, const ViewTree::Node& v, const Float8x3& d, Float8 distance,
                    float radius) {
  if (v.radius > radius) return 0;
  const Float8 nearest = distance - Float8(v.radius);
  // 2 radius / nearest Paraboloid::stretch() < node_texels, without a division
  const Float8 bound = nearest * (distance + abs(d.x));
  return movemask(nearest > Float8(radius) && bound > Float8(radius * size) * distance);
}

}  // namespace

ViewRendering::ViewRendering(const Octree& scene, const ViewTree& views,
                             const ManyViewsSettings& settings)
    : scene_(scene), views_(views), settings_(settings), map_{settings.map_size} {
  const std::size_t floats = (texels() + 7) / 8 * 8;
  for (std::vector<float>* v : {&x_, &y_, &z_}) v->assign(floats, 0.0F);
  for (int i = 0; i < map_.texels(); ++i) {
    const V3f w = map_.direction(i);
    x_[static_cast<std::size_t>(i)] = w.x;
    y_[static_cast<std::size_t>(i)] = w.y;
    z_[static_cast<std::size_t>(i)] = w.z;
  }
  for (int level = 0; level <= scene.levels(); ++level) {
    sizes_.push_back({scene.radius(level), static_cast<float>(std::ldexp(scene.side, -level - 1))});
  }
  below_.assign(views.tree().nodes.size(), 0);
  for (auto i = static_cast<std::uint32_t>(below_.size()); i-- > 0;) {
    const Octree::Node& v = views.tree().nodes[i];
    if (v.children == 0) below_[i] = 1;
    for (std::uint32_t c = 0; c < v.children; ++c) below_[i] += below_[v.first_child + c];
  }
}

inline ViewRendering::Eight ViewRendering::eight(const Siblings& s, const ViewTree::Node& v) const {
  Eight e;
  V3f middle;  // of the parent's cube
  if (s.parent == Siblings::no_parent) {
    e.level = 0;
    e.first_child = 0;
    e.octants = 1;
    middle = scene_.nodes[0].centre + V3f(static_cast<float>(scene_.side) / 2);
  } else {
    const Octree::Node& parent = scene_.nodes[s.parent];
    e.level = parent.level + 1;
    e.first_child = parent.first_child;
    e.octants = parent.octants;
    middle = parent.centre;
  }
  e.there = s.octants & e.octants;
  const LevelSize& size = sizes_[static_cast<std::size_t>(e.level)];
  e.radius = size.radius;
  const V3f d = middle - v.centre;
  e.d = Float8x3{d.x, d.y, d.z} + octant_signs() * Float8(size.half_side);
  e.distance = sqrt(length2(e.d));
  return e;
}

/// What is the same for all that a view node looks at.
struct ViewRendering::Visit {
  const ViewTree::Node& v;
  bool leaf;
  int level;   // of the views' octree
  float size;  // of the map, over node_texels
  std::span<float> depths;
  Undecided& left;
  ManyViewsCounts counts = {};

  void splat(int texel, float distance) const {
    float& depth = depths[static_cast<std::size_t>(texel)];
    depth = std::min(depth, distance);
  }
};

inline ViewRendering::Visit ViewRendering::visit(std::uint32_t view, std::span<float> depths,
                                                 Undecided& left) const {
  return {.v = views_.node(view),
          .leaf = is_leaf(view),
          .level = settings_.share ? views_.tree().nodes[view].level : 0,
          .size = static_cast<float>(map_.size) / settings_.node_texels,
          .depths = depths,
          .left = left};
}

inline void ViewRendering::look(const Siblings& siblings, Visit& visit) const {
  const Eight e = eight(siblings, visit.v);
  const bool scene_leaves = e.level == scene_.levels();
  ManyViewsCounts& counts = visit.counts;
  const auto looked = static_cast<std::uint64_t>(std::popcount(e.there));
  counts.pairs += looked;
  counts.generations[static_cast<std::size_t>(e.level + visit.level)] += looked;
  const unsigned out = settings_.cull ? e.there & outside(visit.v, e.d, e.distance, e.radius) : 0;
  counts.culled += static_cast<std::uint64_t>(std::popcount(out));
  unsigned rest = e.there & ~out;
  unsigned same = 0;
  if (settings_.merge || scene_leaves) {
    same = rest & same_texel(visit.size, visit.v, e.d, e.distance, e.radius);
  }
  if (same != 0) {
    alignas(32) std::array<float, 8> distances;
    alignas(32) std::array<int, 8> texels;
    e.distance.store(distances.data());
    const Paraboloid::Eight places = map_.places(e.d, e.distance);
    map_.texel(places).store(texels.data());
    const float cover = settings_.cover;
    const unsigned shown =
        cover > 0 ? same & movemask(map_.covers_middle(places, e.radius * cover)) : same;
    for_each_bit(shown, [&](int i) {
      visit.splat(texels[static_cast<std::size_t>(i)], distances[static_cast<std::size_t>(i)]);
    });
  }
  rest &= ~same;
  unsigned rendered = same;
  if (visit.leaf && scene_leaves) {
    if (rest != 0) fill(e, rest, visit.depths);
    counts.large += static_cast<std::uint64_t>(std::popcount(rest));
    rendered |= rest;
  } else if (!visit.leaf && (scene_leaves || e.radius / 2 < visit.v.radius)) {  // Fig. 8
    if (rest != 0) {
      visit.left.later.push_back({siblings.parent, static_cast<std::uint8_t>(rest)});
    }
  } else {
    for_each_bit(rest, [&](int i) { visit.left.here.push_back(Siblings::all_of(e.node(i))); });
  }
  counts.splats += static_cast<std::uint64_t>(std::popcount(rendered));
}

void ViewRendering::render(std::uint32_t view, std::span<const Siblings> waiting,
                           std::span<float> depths, Undecided& left,
                           ManyViewsCounts& counts) const {
  Visit own = visit(view, depths, left);
  for (const Siblings& first : waiting) {
    look(first, own);
    while (!left.here.empty()) {
      const Siblings next = left.here.back();
      left.here.pop_back();
      look(next, own);
    }
  }
  own.counts.sharing = own.counts.splats * below_[view];
  counts += own.counts;
}

void ViewRendering::render_once(std::uint32_t view, std::span<const Siblings> waiting,
                                std::span<float> depths, Undecided& left,
                                ManyViewsCounts& counts) const {
  Visit own = visit(view, depths, left);
  for (const Siblings& siblings : waiting) look(siblings, own);
  own.counts.sharing = own.counts.splats * below_[view];
  counts += own.counts;
}

/// All texels whose middle the sphere covers (3.2.4); as published that of its centre, too.
void ViewRendering::fill(const Eight& e, unsigned lanes, std::span<float> depths) const {
  alignas(32) std::array<float, 8> x, y, z, distances;
  e.d.x.store(x.data());
  e.d.y.store(y.data());
  e.d.z.store(z.data());
  e.distance.store(distances.data());
  const float radius = settings_.cover > 0 ? settings_.cover * e.radius : e.radius;
  for_each_bit(lanes, [&](int lane) {
    const auto i = static_cast<std::size_t>(lane);
    const float distance = distances[i];
    const auto run = [&](int first, int n) {
      float* const from = depths.data() + first;
      for (int k = 0; k < n; ++k) from[k] = std::min(from[k], distance);
    };
    if (distance == 0) return run(0, map_.texels());
    const V3f d(x[i], y[i], z[i]);
    if (settings_.cover == 0) run(map_.texel(d), 1);
    const float sine = distance > radius ? radius / distance : 1;
    const float cosine = std::sqrt(std::max(0.0F, 1 - sine * sine));
    map_.for_each_run(d / distance, cosine, sine, run);
  });
}

void ViewRendering::hand_down(std::uint32_t parent, std::span<const float> from,
                              std::uint32_t child, std::span<float> to) const {
  const V3f step = views_.node(parent).centre - views_.node(child).centre;
  const Float8x3 s{step.x, step.y, step.z};
  for (std::size_t i = 0; i < from.size(); i += 8) {
    const auto depth = Float8::load_unaligned(&from[i]);
    const Float8x3 w{Float8::load_unaligned(&x_[i]), Float8::load_unaligned(&y_[i]),
                     Float8::load_unaligned(&z_[i])};
    const Float8 moved = sqrt(length2(s + w * depth));
    select(Float8(nothing) > depth, moved, Float8(nothing)).store_unaligned(&to[i]);
  }
}

}  // namespace lacuna
