#include "renderer/visibility/virtual_lights.h"

#include <algorithm>

#include "renderer/core/morton.h"

namespace lacuna {

namespace {

constexpr auto block_size = static_cast<std::size_t>(Lanes::size);

/// The axis that `n` is nearest to, and its sign: 0 to 5.
std::uint64_t main_direction(const V3f& n) {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
  }
  return static_cast<std::uint64_t>(2 * axis + (n[axis] < 0 ? 1 : 0));
}

/// `lights` by the way they face, and then along a space-filling curve; as they are where they lie
/// at one place.
template <class Light, class Position, class Normal>
std::vector<std::size_t> near_one_another(const std::vector<Light>& lights, Position&& position,
                                          Normal&& normal) {
  Bounds box;
  for (const Light& l : lights) box.add(position(l));
  const MortonOrder order(box);
  std::vector<std::pair<std::uint64_t, std::size_t>> codes(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    codes[i] = {main_direction(normal(lights[i])) << 61 | order(position(lights[i])) >> 2, i};
  }
  std::sort(codes.begin(), codes.end());
  std::vector<std::size_t> result(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) result[i] = codes[i].second;
  return result;
}

}  // namespace

void VirtualLights::add(Kept& path, const EmitterPoint& e) const {
  if (!e.pdf.positive()) return;
  if (e.kind == EmitterPoint::Kind::area && !e.both_sides) {
    path.diffuse.push_back({e.x, e.ng, e.ng, 1, e.emission * (share_ / e.pdf.value), e.extent, 0});
  } else {
    path.general.push_back({e, 0});
  }
}

void VirtualLights::add(Kept& path, const Vertex& v, int index) const {
  if (const std::optional<LambertLit> lit = v.bsdf->lambert_lit(v.wp)) {
    const Rgb rgb = v.throughput * lit->f * share_;
    if (is_black(rgb)) return;
    path.diffuse.push_back(
        {v.surface.x, lit->side, lit->ns, lit->turned, rgb, v.surface.extent, index});
  } else {
    path.general.push_back({v, index});
  }
}

void VirtualLights::arrange() {
  for (int index = 0; index < choice_.longest; ++index) {
    std::vector<Diffuse> diffuse;
    std::vector<GeneralLight> general;
    for (const Kept& path : kept_) {
      for (const Diffuse& l : path.diffuse) {
        if (l.index == index) diffuse.push_back(l);
      }
      for (const GeneralLight& l : path.general) {
        if (l.index == index) general.push_back(l);
      }
    }
    size_ += diffuse.size() + general.size();
    arrange_diffuse(diffuse);
    arrange_general(general);
    ends_.push_back(blocks_.size());
  }
  kept_ = {};
}

void VirtualLights::arrange_diffuse(std::vector<Diffuse>& lights) {
  const auto order = near_one_another(
      lights, [](const Diffuse& l) { return l.x; }, [](const Diffuse& l) { return l.ng; });
  for (std::size_t first = 0; first < lights.size(); first += block_size) {
    const auto count = static_cast<int>(std::min(block_size, lights.size() - first));
    blocks_.push_back({diffuse_.size(), count, true});
    DiffuseBlock& block = diffuse_.emplace_back();
    BlockBounds& bounds = bounds_.emplace_back();
    for (int i = 0; i < Lanes::size; ++i) {
      // A missing one stands where another does, so that no geometry of it is special.
      const Diffuse& l = lights[order[first + static_cast<std::size_t>(std::min(i, count - 1))]];
      bounds.add(l.x, l.ng);
      const auto put = [i](const V3f& p, Lanes& x, Lanes& y, Lanes& z) {
        x[i] = p.x, y[i] = p.y, z[i] = p.z;
      };
      put(l.x, block.x, block.y, block.z);
      put(l.ng, block.gx, block.gy, block.gz);
      put(l.ns, block.sx, block.sy, block.sz);
      put(i < count ? l.rgb : Rgb(0, 0, 0), block.r, block.g, block.b);
      block.turned[i] = l.turned;
      block.extent[i] = l.extent;
    }
  }
}

void VirtualLights::arrange_general(std::vector<GeneralLight>& lights) {
  const auto position = [](const GeneralLight& l) {
    if (const auto* v = std::get_if<Vertex>(&l.at)) return v->surface.x;
    return std::get<EmitterPoint>(l.at).x;
  };
  const auto order = near_one_another(lights, position, [](const auto&) { return V3f(1, 0, 0); });
  for (std::size_t first = 0; first < lights.size(); first += block_size) {
    const std::size_t count = std::min(block_size, lights.size() - first);
    blocks_.push_back({general_.size(), static_cast<int>(count), false});
    for (std::size_t i = 0; i < count; ++i) general_.push_back(lights[order[first + i]]);
  }
}

}  // namespace lacuna
