#include "renderer/many_lights/vpl_set.h"

#include <algorithm>
#include <tuple>

#include "renderer/core/morton.h"

namespace lacuna {

namespace {

constexpr auto block_size = static_cast<std::size_t>(Lanes::size);

/// The signed axis nearest to `n`: 0 to 5.
std::uint64_t main_direction(const V3f& n) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
  }
  return static_cast<std::uint64_t>(2 * axis + (n[axis] < 0 ? 1 : 0));
}

/// A part of a list of lights: at most 64 of one group.
struct Run {
  LightGroup group;
  std::vector<std::size_t> lights;
};

/// Sorts lights by group, by the axis of their normal, and along a space-filling curve; lights at
/// equal positions keep their order.
template <class Light, class Geometry>
std::vector<Run> sorted_runs(const std::vector<Light>& lights, const LightGroups& groups,
                             Geometry&& geometry) {
  Bounds box;
  for (const Light& l : lights) box.add(geometry(l).x);
  const MortonOrder order(box);
  struct Key {
    LightGroup group;
    std::uint64_t code;
    std::size_t light;
    bool operator<(const Key& k) const {
      return std::tie(group, code, light) < std::tie(k.group, k.code, k.light);
    }
  };
  std::vector<Key> keys(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const VplGeometry p = geometry(lights[i]);
    keys[i] = {groups(p), main_direction(p.n) << 61 | order(p.x) >> 2, i};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Run> runs;
  for (const Key& k : keys) {
    if (runs.empty() || runs.back().group != k.group || runs.back().lights.size() == block_size) {
      runs.push_back({k.group, {}});
    }
    runs.back().lights.push_back(k.light);
  }
  return runs;
}

}  // namespace

void VplSet::add(StoredLights& path, const EmitterPoint& e) const {
  if (!e.pdf.positive()) return;
  if (e.kind == EmitterPoint::Kind::area && !e.both_sides) {
    path.diffuse.push_back({e.x, e.ng, e.ng, 1, e.emission * (share_ / e.pdf.value), e.offset, 0});
  } else if (e.kind == EmitterPoint::Kind::point && e.contact == nullptr) {
    const V3f everywhere(0.0F);
    path.points.push_back(
        {e.x, everywhere, everywhere, 1, e.emission * (share_ / e.pdf.value), 0, 0});
  } else {
    path.general.emplace_back(e, 0);
  }
}

void VplSet::add(StoredLights& path, const Vertex& v, int index) const {
  if (const std::optional<LambertLobe> lobe = v.bsdf->lambert_lobe(v.wp)) {
    const Rgb rgb = v.throughput * lobe->f * share_;
    if (is_black(rgb)) return;
    path.diffuse.push_back({v.surface.x, lobe->side, lobe->ns, lobe->shading_cosine_ratio, rgb,
                            v.surface.offset, index});
  } else {
    path.general.emplace_back(v, index);
  }
}

VplGeometry GeneralLight::geometry() const {
  if (const auto* v = std::get_if<Vertex>(&at)) return {v->surface.x, v->side(), false};
  const auto& e = std::get<EmitterPoint>(at);
  return {e.x, e.infinite() ? V3f(0.0F) : e.ng, e.infinite()};
}

VplGeometry VplSet::geometry(std::size_t b, int i) const {
  const DiffuseBlock* from = diffuse(b);
  if (from == nullptr) return general(b, i).geometry();
  return {V3f(from->x[i], from->y[i], from->z[i]), V3f(from->gx[i], from->gy[i], from->gz[i]),
          false};
}

void VplSet::arrange(const LightGroups& groups) {
  for (int index = 0; index < choice_.longest; ++index) {
    const auto all = [&](auto StoredLights::*kind) {
      auto found = (StoredLights{}.*kind);
      for (const StoredLights& path : kept_) {
        for (const auto& l : path.*kind) {
          if (l.index == index) found.push_back(l);
        }
      }
      size_ += found.size();
      return found;
    };
    arrange_diffuse(all(&StoredLights::diffuse), false, groups);
    arrange_diffuse(all(&StoredLights::points), true, groups);
    arrange_general(all(&StoredLights::general), groups);
    ends_.push_back(blocks_.size());
  }
  kept_ = {};
}

void VplSet::arrange_diffuse(const std::vector<Diffuse>& lights, bool points,
                             const LightGroups& groups) {
  const auto geometry = [](const Diffuse& l) { return VplGeometry{l.x, l.ng, false}; };
  for (const Run& run : sorted_runs(lights, groups, geometry)) {
    const auto count = static_cast<int>(run.lights.size());
    blocks_.push_back({diffuse_.size(), count, true, run.group});
    DiffuseBlock& block = diffuse_.emplace_back();
    block.points = points;
    BlockBounds& bounds = bounds_.emplace_back();
    for (int i = 0; i < Lanes::size; ++i) {
      // An unused lane copies the geometry of a light, to avoid special values.
      const Diffuse& l = lights[run.lights[static_cast<std::size_t>(std::min(i, count - 1))]];
      bounds.add({l.x, l.ng});
      const auto put = [i](const V3f& p, Lanes& x, Lanes& y, Lanes& z) {
        x[i] = p.x, y[i] = p.y, z[i] = p.z;
      };
      put(l.x, block.x, block.y, block.z);
      put(l.ng, block.gx, block.gy, block.gz);
      put(l.ns, block.sx, block.sy, block.sz);
      put(i < count ? l.rgb : Rgb(0, 0, 0), block.r, block.g, block.b);
      block.shading_cosine_ratio[i] = l.shading_cosine_ratio;
      block.offset[i] = l.offset;
    }
  }
}

void VplSet::arrange_general(const std::vector<GeneralLight>& lights, const LightGroups& groups) {
  const auto geometry = [](const GeneralLight& l) { return l.geometry(); };
  for (const Run& run : sorted_runs(lights, groups, geometry)) {
    blocks_.push_back({general_.size(), static_cast<int>(run.lights.size()), false, run.group});
    for (const std::size_t i : run.lights) general_.push_back(lights[i]);
  }
}

}  // namespace lacuna
