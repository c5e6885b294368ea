#include "analysis/space_analysis/space_codecs.h"

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

template <class Values>
void require_below(const Values& values, std::size_t bound, const char* what) {
  require(std::all_of(values.begin(), values.end(), [bound](auto v) { return v < bound; }), what);
}

/// Checks offsets of consecutive lists: ascending from 0 to `total`, one more than there are lists.
template <class Values>
void require_offsets(const Values& first, std::size_t lists, std::size_t total, const char* what) {
  require(first.size() == lists + 1 && first.front() == 0 && first.back() == total &&
              std::is_sorted(first.begin(), first.end()),
          what);
}

bool is_finite(const Imath::V3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

void Codec<Voxels>::write(ArtefactWriter& out, const Voxels& v) {
  encode(out, v.transform, v.scene);
}
Voxels Codec<Voxels>::read(ArtefactReader& in) {
  Voxels v;
  v.transform = decode<GridTransform>(in);
  v.scene = decode<BitGrid3>(in);
  return v;
}

void Codec<Domain>::write(ArtefactWriter& out, const Domain& d) {
  encode(out, d.voxels, d.components_kept, d.components_dropped, d.voxels_kept, d.voxels_dropped,
         d.seeds_buried);
}
Domain Codec<Domain>::read(ArtefactReader& in) {
  Domain d;
  d.voxels = decode<BitGrid3>(in);
  for (std::uint64_t* n : {&d.components_kept, &d.components_dropped, &d.voxels_kept,
                           &d.voxels_dropped, &d.seeds_buried}) {
    *n = decode<std::uint64_t>(in);
  }
  return d;
}

void Codec<FilteredSkeleton>::write(ArtefactWriter& out, const FilteredSkeleton& s) {
  encode(out, s.graph, s.source, s.parent);
}
FilteredSkeleton Codec<FilteredSkeleton>::read(ArtefactReader& in) {
  FilteredSkeleton s;
  s.graph = decode<SkeletonGraph>(in);
  s.source = decode<std::vector<std::uint32_t>>(in);
  s.parent = decode<std::vector<std::uint32_t>>(in);
  require(s.source.size() == s.graph.nodes(), "a filtered node has a source");
  require_below(s.source, s.parent.size(), "sources are nodes of the whole skeleton");
  require_below(s.parent, s.graph.nodes(), "parents are filtered nodes");
  return s;
}

void Codec<SimplifiedSkeleton>::write(ArtefactWriter& out, const SimplifiedSkeleton& s) {
  std::vector<std::uint8_t> kinds(s.kinds.size());
  std::transform(s.kinds.begin(), s.kinds.end(), kinds.begin(),
                 [](NodeKind k) { return static_cast<std::uint8_t>(k); });
  encode(out, s.graph, kinds, s.source, s.parent);
}
SimplifiedSkeleton Codec<SimplifiedSkeleton>::read(ArtefactReader& in) {
  SimplifiedSkeleton s;
  s.graph = decode<SkeletonGraph>(in);
  const auto kinds = decode<std::vector<std::uint8_t>>(in);
  s.source = decode<std::vector<std::uint32_t>>(in);
  s.parent = decode<std::vector<std::uint32_t>>(in);
  require(kinds.size() == s.graph.nodes() && s.source.size() == s.graph.nodes(),
          "a simplified node has a kind and a source");
  require_below(kinds, static_cast<std::size_t>(NodeKind::coverage) + 1,
                "kinds of nodes must be known");
  require_below(s.source, s.parent.size(), "sources are nodes of the whole skeleton");
  require_below(s.parent, s.graph.nodes(), "parents are simplified nodes");
  s.kinds.resize(kinds.size());
  std::transform(kinds.begin(), kinds.end(), s.kinds.begin(),
                 [](std::uint8_t k) { return static_cast<NodeKind>(k); });
  return s;
}

void Codec<VisibilityClusters>::write(ArtefactWriter& out, const VisibilityClusters& c) {
  encode(out, c.count, c.of_node);
}
VisibilityClusters Codec<VisibilityClusters>::read(ArtefactReader& in) {
  VisibilityClusters c;
  c.count = decode<std::uint32_t>(in);
  c.of_node = decode<std::vector<std::uint32_t>>(in);
  require_below(c.of_node, c.count, "nodes lie in existing clusters");
  return c;
}

void Codec<VisibilityGates>::write(ArtefactWriter& out, const VisibilityGates& g) {
  out.put(static_cast<std::uint64_t>(g.gates.size()));
  for (const VisibilityGate& gate : g.gates) {
    encode(out, gate.centre, gate.axis, gate.radius, gate.clusters, gate.nodes);
  }
  encode(out, g.first, g.by_cluster);
}
VisibilityGates Codec<VisibilityGates>::read(ArtefactReader& in) {
  VisibilityGates g;
  constexpr std::size_t bytes = 7 * sizeof(float) + 4 * sizeof(std::uint32_t);
  g.gates.resize(in.get_length(bytes));
  for (VisibilityGate& gate : g.gates) {
    gate.centre = decode<Imath::V3f>(in);
    gate.axis = decode<Imath::V3f>(in);
    gate.radius = decode<float>(in);
    gate.clusters = decode<std::array<std::uint32_t, 2>>(in);
    gate.nodes = decode<std::array<std::uint32_t, 2>>(in);
    require(is_finite(gate.centre) && is_finite(gate.axis) && gate.radius >= 0 &&
                std::isfinite(gate.radius),
            "a gate is a disk");
  }
  g.first = decode<std::vector<std::uint32_t>>(in);
  g.by_cluster = decode<std::vector<std::uint32_t>>(in);
  require(!g.first.empty(), "gates are listed by cluster");
  require_offsets(g.first, g.first.size() - 1, g.by_cluster.size(),
                  "lists of gates are consecutive");
  require_below(g.by_cluster, g.gates.size(), "lists contain existing gates");
  for (const VisibilityGate& gate : g.gates) {
    require_below(gate.clusters, g.first.size() - 1, "gates lie between existing clusters");
  }
  return g;
}

void Codec<RegionLabels>::write(ArtefactWriter& out, const RegionLabels& r) {
  encode(out, r.label, r.opening, r.pieces_joined);
  out.put(static_cast<std::uint64_t>(r.regions.size()));
  for (const Region& region : r.regions) encode(out, region.voxels, region.opening, region.root);
}
RegionLabels Codec<RegionLabels>::read(ArtefactReader& in) {
  RegionLabels r;
  r.label = decode<Grid3<std::uint32_t>>(in);
  r.opening = decode<Grid3<std::uint16_t>>(in);
  r.pieces_joined = decode<std::uint64_t>(in);
  require(r.opening.size() == r.label.size(), "labels and openings are of one grid");
  constexpr std::size_t bytes =
      sizeof(Region::voxels) + sizeof(Region::opening) + sizeof(Region::root);
  r.regions.resize(in.get_length(bytes));
  for (Region& region : r.regions) {
    region.voxels = decode<std::uint64_t>(in);
    region.opening = decode<std::uint16_t>(in);
    region.root = decode<std::uint32_t>(in);
    require(region.root < r.label.count(), "a region's root is a voxel");
  }
  for (std::size_t i = 0; i < r.label.count(); ++i) {
    require(r.label[i] < r.regions.size() || r.label[i] == no_region, "labels are regions");
  }
  return r;
}

void Codec<Portals>::write(ArtefactWriter& out, const Portals& p) {
  out.put(static_cast<std::uint64_t>(p.portals.size()));
  for (const Portal& portal : p.portals) {
    encode(out, portal.a, portal.b, portal.first, portal.by_side);
  }
  encode(out, p.voxels, p.first, p.of_region);
}
Portals Codec<Portals>::read(ArtefactReader& in) {
  Portals p;
  p.portals.resize(in.get_length(8 * sizeof(std::uint32_t) + sizeof(Portal::first)));
  for (Portal& portal : p.portals) {
    portal.a = decode<std::uint32_t>(in);
    portal.b = decode<std::uint32_t>(in);
    portal.first = decode<std::uint64_t>(in);
    portal.by_side = decode<std::array<std::uint32_t, 6>>(in);
  }
  p.voxels = decode<std::vector<std::uint32_t>>(in);
  p.first = decode<std::vector<std::uint32_t>>(in);
  p.of_region = decode<std::vector<std::uint32_t>>(in);
  require(!p.first.empty(), "portals are listed by region");
  const std::size_t regions = p.first.size() - 1;
  require_offsets(p.first, regions, p.of_region.size(), "lists of portals are consecutive");
  require_below(p.of_region, p.portals.size(), "lists contain existing portals");
  for (const Portal& portal : p.portals) {
    require(portal.a < portal.b && portal.b < regions, "portals lie between existing regions");
    require(portal.first <= p.voxels.size() && portal.faces() <= p.voxels.size() - portal.first,
            "a portal has faces");
  }
  return p;
}

/// Stores the octants of every inner node, from the root on, which determine the rest.
void Codec<Octree>::write(ArtefactWriter& out, const Octree& tree) {
  std::vector<std::uint8_t> octants;
  for (const Octree::Node& n : tree.nodes) {
    if (n.children > 0) octants.push_back(n.octants);
  }
  encode(out, tree.corner, tree.side, static_cast<std::uint8_t>(tree.levels()),
         static_cast<std::uint8_t>(tree.empty() ? 0 : 1), octants);
}
Octree Codec<Octree>::read(ArtefactReader& in) {
  const auto corner = decode<Imath::V3d>(in);
  const auto side = decode<double>(in);
  require(is_finite(Imath::V3f(corner)) && side > 0 && std::isfinite(side),
          "the root's cube is a cube");
  const int levels = decode<std::uint8_t>(in);
  require(levels <= Octree::most_levels, "an octree has 12 levels or less");
  const auto roots = decode<std::uint8_t>(in);
  require(roots <= 1, "there is at most one root");
  const auto octants = decode<std::vector<std::uint8_t>>(in);
  std::vector<std::uint64_t> codes(roots, 0);
  std::size_t node = 0;
  for (int level = 0; level < levels; ++level) {
    std::vector<std::uint64_t> below;
    for (const std::uint64_t code : codes) {
      require(node < octants.size() && octants[node] != 0, "inner nodes have children");
      for (unsigned k = 0; k < 8; ++k) {
        if ((octants[node] >> k & 1) != 0) below.push_back(code << 3 | k);
      }
      ++node;
    }
    codes = std::move(below);
  }
  require(node == octants.size(), "every inner node has a parent");
  return build_octree(codes, levels, corner, side);
}

}  // namespace lacuna
