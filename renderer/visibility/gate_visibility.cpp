#include "renderer/visibility/gate_visibility.h"

namespace lacuna {

namespace {

/// The positions of a block's lights.
struct Positions {
  Lanes x, y, z;

  Positions(const VplSet& lights, std::size_t block) {
    if (const DiffuseBlock* from = lights.diffuse(block)) {
      x = from->x, y = from->y, z = from->z;
      return;
    }
    for (int i = 0; i < lights.count(block); ++i) {
      const V3f p = lights.geometry(block, i).x;
      x[i] = p.x, y[i] = p.y, z[i] = p.z;
    }
  }
};

}  // namespace

void GateVisibility::prepare(const PrepareContext& context) {
  SpaceAnalysis& space = context.space;
  const GridTransform transform = space.voxels().transform;
  clusters_.emplace(space);
  if (!settings_.through_gates) return;  // gates are not built
  const VisibilityGates& all = space.gates();
  first_ = all.first;
  for (const std::uint32_t i : all.by_cluster) {
    const VisibilityGate& g = all.gates[i];
    const double radius = double(g.radius) * transform.voxel_size;
    gates_.push_back(
        {V3f(transform.to_world(V3d(g.centre))), g.axis, static_cast<float>(radius * radius)});
  }
}

Counters GateVisibility::begin(const LightPass& pass) {
  lights_ = &pass.terms.lights();
  cluster_of_block_.clear();
  for (std::size_t b = 0; b < lights_->blocks(); ++b) {
    cluster_of_block_.push_back(group(lights_->geometry(b, 0)));
  }
  return {};
}

/// The fraction of light in unit direction `w` that passes a gate.
Float8 GateVisibility::through(const Gate& gate, const Float8x3& to_gate, const Float8x3& w) const {
  const Float8x3 axis{gate.axis.x, gate.axis.y, gate.axis.z};
  const Float8 t = dot(to_gate, axis) / dot(w, axis);
  const Float8x3 from_centre = w * t + to_gate * -1.0F;
  const Float8 r2 = length2(from_centre);
  const Mask8 crosses = t > 0 && Float8(gate.radius2) >= r2;
  switch (settings_.falloff) {
    case GateFalloff::cosine:
      return keep_where(crosses, max(0.0F, dot(w, to_gate) / sqrt(length2(to_gate))));
    case GateFalloff::rim:
      return keep_where(crosses, max(0.0F, 1 - r2 / gate.radius2));
    case GateFalloff::none:
      break;
  }
  return keep_where(crosses, 1.0F);
}

void GateVisibility::share(std::span<const ShadingPoint> points, std::span<At> states,
                           const IterationContext& context) const {
  if (settings_.tests == GateTests::points || !settings_.through_gates) return;
  std::vector<std::uint32_t> cluster, geometry;
  for (const At& at : states) cluster.push_back(at.cluster);
  const auto shared =
      std::make_shared<GeometryClusters>(points, cluster, context.camera, counts_, geometry);
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].shared = shared;
    states[i].geometry = geometry[i];
  }
}

const std::vector<GeometryCluster::Listed>& GateVisibility::listed(const At& at,
                                                                   std::size_t block) const {
  GeometryCluster& points = at.shared->clusters[at.geometry];
  if (points.block == block) return points.list;
  points.block = block;
  points.list.clear();
  const Positions lights(*lights_, block);
  const std::uint32_t cluster = cluster_of_block_[block];
  for (std::uint32_t g = first_[cluster]; g < first_[cluster + 1]; ++g) {
    const V3f c = gates_[g].centre, x = points.centre;
    std::uint64_t meets = 0;
    for (int k = 0; k < Lanes::groups; ++k) {
      const Float8x3 y{lights.x.eight(k), lights.y.eight(k), lights.z.eight(k)};
      const Float8x3 to_gate{c.x - y.x, c.y - y.y, c.z - y.z};
      const Float8x3 to_points{x.x - y.x, x.y - y.y, x.z - y.z};
      const unsigned bits = cone_meets(to_gate, gates_[g].radius2, to_points, points.radius);
      meets |= std::uint64_t{bits} << (8 * k);
    }
    meets &= lights_->mask(block);
    at.shared->sphere_tests += static_cast<std::uint64_t>(lights_->count(block));
    if (meets != 0) points.list.push_back({g, meets});
  }
  return points.list;
}

void GateVisibility::decide(const At& at, std::size_t block, const Terms& terms,
                            VisibilityEstimate& d) const {
  const std::uint32_t cluster = cluster_of_block_[block];
  if (cluster == no_group || at.cluster == no_group) return test_all(terms, d);
  d.tests = 0;
  if (cluster == at.cluster) {
    d.untested.v.fill(1);
    return;
  }
  const Positions lights(*lights_, block);
  for (int k = 0; k < Lanes::groups; ++k) {
    const Float8x3 y{lights.x.eight(k), lights.y.eight(k), lights.z.eight(k)};
    const Float8x3 to_point{at.x.x - y.x, at.x.y - y.y, at.x.z - y.z};
    const Float8x3 w = to_point * (1 / sqrt(length2(to_point)));
    Float8 v = 0.0F;
    const auto pass = [&](std::uint32_t g) {
      const V3f c = gates_[g].centre;
      v = max(v, through(gates_[g], {c.x - y.x, c.y - y.y, c.z - y.z}, w));
    };
    if (at.shared) {
      for (const GeometryCluster::Listed& l : listed(at, block)) {
        if ((l.lights >> (8 * k) & 0xff) != 0) pass(l.gate);
      }
    } else {
      for (std::uint32_t g = first_[cluster]; g < first_[cluster + 1]; ++g) pass(g);
    }
    d.untested.set(k, v);
  }
}

bool GateVisibility::lists_none(const At& at, std::size_t block) const {
  const std::uint32_t cluster = cluster_of_block_[block];
  const std::vector<GeometryCluster::Listed>& list = listed(at, block);
  for (const GeometryCluster::Listed& l : list) {
    at.shared->point_tests += static_cast<std::uint64_t>(std::popcount(l.lights));
  }
  at.shared->all_tests += std::uint64_t{first_[cluster + 1] - first_[cluster]} *
                          static_cast<std::uint64_t>(lights_->count(block));
  return list.empty();
}

std::vector<std::pair<std::string, double>> GateVisibility::statistics() const {
  std::vector<std::pair<std::string, double>> stats{
      {"visibility_clusters", static_cast<double>(clusters_->count())},
      {"visibility_gates", static_cast<double>(gates_.size()) / 2}};
  if (settings_.tests == GateTests::points) return stats;
  stats.emplace_back("geometry_clusters", static_cast<double>(counts_.clusters));
  stats.emplace_back("gate_tests_of_clusters", static_cast<double>(counts_.spheres));
  stats.emplace_back("gate_tests_of_points", static_cast<double>(counts_.points));
  stats.emplace_back("gate_tests_without_clusters", static_cast<double>(counts_.all));
  return stats;
}

}  // namespace lacuna
