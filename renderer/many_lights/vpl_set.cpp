#include "renderer/many_lights/vpl_set.h"

#include <algorithm>
#include <tuple>

#include "base/parallel/for_each_chunked.h"
#include "renderer/core/morton.h"
#include "renderer/path/light_pass.h"

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

/// A part of SortedLights: at most 64 lights of one group.
struct Run {
  LightGroup group;
  std::vector<std::size_t> lights;
};

/// Lights by group, by the axis of their normal, and along a space-filling curve; lights at equal
/// positions keep their order.
template <class Light>
struct SortedLights {
  std::vector<Light> lights;
  std::vector<Run> runs;
};

template <class Light>
std::vector<Run> sorted_runs(const std::vector<Light>& lights, const LightGroups& groups) {
  Bounds box;
  for (const Light& l : lights) box.add(l.geometry().x);
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
    const VplGeometry p = lights[i].geometry();
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

/// The lights of one kind that are vertex `index` of their path.
template <class Light, class Stored>
SortedLights<Light> sorted(const std::vector<std::vector<Stored>>& parts,
                           std::vector<Light> Stored::*kind, std::size_t index,
                           const LightGroups& groups) {
  SortedLights<Light> all;
  for (const std::vector<Stored>& part : parts) {
    const std::vector<Light>& more = part[index].*kind;
    all.lights.insert(all.lights.end(), more.begin(), more.end());
  }
  all.runs = sorted_runs(all.lights, groups);
  return all;
}

/// Writes the chosen lights, at most 64.
template <class Light>
BlockBounds write(const std::vector<Light>& lights, std::span<const std::size_t> chosen,
                  DiffuseBlock& block) {
  BlockBounds bounds;
  const auto count = static_cast<int>(chosen.size());
  for (int i = 0; i < Lanes::size; ++i) {
    // An unused lane copies the geometry of a light, to avoid special values.
    const Light& l = lights[chosen[static_cast<std::size_t>(std::min(i, count - 1))]];
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
  return bounds;
}

}  // namespace

VplSet::VplSet(std::size_t paths, const Choice& choice)
    : choice_(choice),
      share_(1.0F / float(paths)),
      kept_(paths / paths_of_part + 1, PartLights(static_cast<std::size_t>(choice.longest))) {}

void VplSet::keep(std::size_t path, const LightBatch& batch, std::size_t i) {
  PartLights& part = kept_[path / paths_of_part];
  const bool started = std::min(batch.length(i), choice_.longest) > 0;
  if (started && choice_.emitters) add(part[0], batch.emitter(i));
  batch.for_each_vertex(i, [&](std::size_t j, int index) {
    if (index >= choice_.longest) return;
    const Vertex& v = batch.vertex(j, index);
    if (!v.bsdf->is_vpl_receiver(choice_.least_alpha)) return;
    add(part[static_cast<std::size_t>(index)], v, index);
  });
}

void VplSet::add(StoredLights& part, const EmitterPoint& e) const {
  if (!e.pdf.positive()) return;
  if (e.kind == EmitterPoint::Kind::area && !e.both_sides) {
    part.diffuse.push_back({e.x, e.ng, e.ng, 1, e.emission * (share_ / e.pdf.value), e.offset});
  } else if (e.kind == EmitterPoint::Kind::point && e.contact == nullptr) {
    const V3f everywhere(0.0F);
    part.points.push_back({e.x, everywhere, everywhere, 1, e.emission * (share_ / e.pdf.value), 0});
  } else {
    part.general.emplace_back(e, 0);
  }
}

void VplSet::add(StoredLights& part, const Vertex& v, int index) const {
  if (const std::optional<LambertLobe> lobe = v.bsdf->lambert_lobe(v.wp)) {
    const Rgb rgb = v.throughput * lobe->f * share_;
    if (is_black(rgb)) return;
    part.diffuse.push_back(
        {v.surface.x, lobe->side, lobe->ns, lobe->shading_cosine_ratio, rgb, v.surface.offset});
  } else {
    part.general.emplace_back(v, index);
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

void VplSet::arrange(const LightGroups& groups, const ThreadPool& pool) {
  struct OfLength {
    SortedLights<Diffuse> diffuse, points;
    SortedLights<GeneralLight> general;
  };
  std::vector<OfLength> lengths(static_cast<std::size_t>(choice_.longest));
  pool.for_each(3 * choice_.longest, [&](int i) {
    const auto index = static_cast<std::size_t>(i / 3);
    OfLength& of = lengths[index];
    if (i % 3 == 0) of.diffuse = sorted(kept_, &StoredLights::diffuse, index, groups);
    if (i % 3 == 1) of.points = sorted(kept_, &StoredLights::points, index, groups);
    if (i % 3 == 2) of.general = sorted(kept_, &StoredLights::general, index, groups);
  });
  kept_ = {};
  struct Source {
    const std::vector<Diffuse>& lights;
    const Run& run;
    bool points;
  };
  std::vector<Source> sources;  // of diffuse_
  const auto add_diffuse = [&](const SortedLights<Diffuse>& of, bool points) {
    for (const Run& run : of.runs) {
      blocks_.push_back({sources.size(), static_cast<int>(run.lights.size()), true, run.group});
      sources.push_back({of.lights, run, points});
    }
    size_ += of.lights.size();
  };
  for (const OfLength& of : lengths) {
    add_diffuse(of.diffuse, false);
    add_diffuse(of.points, true);
    for (const Run& run : of.general.runs) {
      blocks_.push_back({general_.size(), static_cast<int>(run.lights.size()), false, run.group});
      for (const std::size_t i : run.lights) general_.push_back(of.general.lights[i]);
    }
    size_ += of.general.lights.size();
    ends_.push_back(blocks_.size());
  }
  diffuse_.resize(sources.size());
  bounds_.resize(sources.size());
  for_each_chunked(pool, sources.size(), 64, [&](std::size_t b) {
    diffuse_[b].points = sources[b].points;
    bounds_[b] = write(sources[b].lights, sources[b].run.lights, diffuse_[b]);
  });
}

}  // namespace lacuna
