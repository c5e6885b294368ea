#include "analysis/space_analysis/space_analysis.h"

#include <fmt/format.h>

#include "analysis/artefacts/settings_text.h"
#include "analysis/octree/surface_octree.h"
#include "analysis/skeleton/build_graph.h"
#include "analysis/skeleton/node_map.h"
#include "analysis/skeleton/visible_map.h"
#include "analysis/space/distance.h"
#include "analysis/space/opening.h"
#include "analysis/space/opening_query.h"
#include "analysis/space_analysis/space_codecs.h"

namespace lacuna {
namespace {

/// Incremented when the same inputs give other bits.
constexpr std::uint32_t voxels_version = 1, domain_version = 1, skeleton_version = 1,
                        filtered_version = 1, map_version = 1, simplified_version = 1,
                        clusters_version = 1, gates_version = 1, regions_version = 1,
                        portals_version = 1, octree_version = 1;

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string hash_of(const DomainSeeds& seeds) {
  std::string bytes;
  append(bytes, seeds.from_infinity);
  for (const Seed& s : seeds.points) {
    append(bytes, s.position);
    append(bytes, s.normal.value_or(Imath::V3d(0.0)));
  }
  return key_hash(bytes);
}

std::string hash_of(const BitGrid3& grid) {
  const auto& blocks = grid.data();
  std::string size;
  append(size, grid.size());
  return key_hash(size + key_hash({reinterpret_cast<const char*>(blocks.data()),
                                   blocks.size() * sizeof(BitBlock)}));
}

/// Checks a map from disk against the graph that it refers to; a checksum cannot.
void require_map(const Grid3<std::uint32_t>& map, Imath::V3i size, std::size_t nodes) {
  bool fits = map.size() == size;
  for (std::size_t i = 0; fits && i < map.count(); ++i) fits = map[i] < nodes || map[i] == no_node;
  if (!fits) throw std::runtime_error("the cached node mapping grid does not match its skeleton");
}

}  // namespace

SpaceAnalysis::SpaceAnalysis(SpaceInput input, ArtefactStore& store, const ThreadPool& pool)
    : input_(std::move(input)), store_(store), pool_(pool) {}

template <class T>
const T& SpaceAnalysis::get(Part<T>& part, const ArtefactKey& key,
                            const std::function<T()>& build) {
  pool_.check_stop();
  const WorkSection section(pool_, fmt::format("analysis: {}", part.type));
  if (!part.value) part.value = store_.get<T>(key, build);
  return *part.value;
}

ArtefactKey SpaceAnalysis::voxels_key() const {
  return ArtefactKey(voxels_.type, voxels_version,
                     fmt::format("resolution={}", input_.settings.resolution))
      .from("geometry", input_.geometry);
}

ArtefactKey SpaceAnalysis::domain_key(const DomainSeeds& seeds) const {
  return ArtefactKey(domain_.type, domain_version).from(voxels_key()).from("seeds", hash_of(seeds));
}

ArtefactKey SpaceAnalysis::of_domain(const char* type, std::uint32_t version,
                                     std::string settings) {
  if (domain_hash_.empty()) domain_hash_ = hash_of(domain().voxels);
  return ArtefactKey(type, version, std::move(settings)).from("domain", domain_hash_);
}

ArtefactKey SpaceAnalysis::skeleton_key() {
  return of_domain(skeleton_.type, skeleton_version,
                   fmt::format("distance={} node_radius={}", enum_name(input_.settings.distance),
                               enum_name(input_.settings.node_radius)));
}
ArtefactKey SpaceAnalysis::filtered_key() {
  ArtefactKey key(filtered_.type, filtered_version);
  key.from(skeleton_key());
  // Rounding depends on the scene's units.
  if (input_.settings.node_radius == NodeRadius::chessboard) key.from(voxels_key());
  return key;
}
ArtefactKey SpaceAnalysis::simplified_key() {
  return ArtefactKey(simplified_.type, simplified_version).from(skeleton_key());
}
ArtefactKey SpaceAnalysis::clusters_key() {
  return ArtefactKey(clusters_.type, clusters_version,
                     fmt::format("alpha={}", input_.settings.cluster_alpha))
      .from(simplified_key());
}
ArtefactKey SpaceAnalysis::regions_key() {
  const RegionLabelling by = input_.settings.regions;
  return of_domain(
      regions_.type, regions_version,
      by == RegionLabelling::forest ? std::string() : fmt::format("regions={}", enum_name(by)));
}
ArtefactKey SpaceAnalysis::map_key(const char* type, const ArtefactKey& graph) {
  return of_domain(type, map_version, fmt::format("mapping={}", enum_name(input_.settings.mapping)))
      .from(graph);
}

const Voxels& SpaceAnalysis::voxels() {
  return get<Voxels>(voxels_, voxels_key(), [this] {
    const TriangleSoup triangles = input_.triangles();  // before byte_limit(): it takes memory
    return voxelize(triangles, input_.settings.resolution, pool_, input_.byte_limit());
  });
}

const Domain& SpaceAnalysis::domain() {
  if (!domain_.value) {
    const DomainSeeds seeds = input_.seeds();
    get<Domain>(domain_, domain_key(seeds), [&] {
      const Voxels& all = voxels();
      return restrict_domain(all, seeds, pool_, input_.byte_limit());
    });
  }
  return *domain_.value;
}

const Grid3<std::uint16_t>& SpaceAnalysis::distance() {
  if (!distance_) {
    const BitGrid3& space = domain().voxels;
    distance_ =
        std::make_unique<Grid3<std::uint16_t>>(l1_distance(space, pool_, input_.byte_limit()));
  }
  return *distance_;
}

CubicalComplex SpaceAnalysis::thin_space() {
  const auto thin = [this](const SpaceMaps& maps) {
    ThinningReport report;
    return curvilinear_skeleton(domain().voxels, maps, report, &pool_, input_.byte_limit());
  };
  if (input_.settings.distance == ThinningDistance::chebyshev) {
    const auto& openings = regions().opening;
    const auto steps = chebyshev_distance(domain().voxels, pool_, input_.byte_limit());
    return thin({steps, [&](Imath::V3i v, int radius) { return openings(v) >= radius; }});
  }
  const OpeningQuery opening(distance(), pool_);
  return thin({distance(), [&](Imath::V3i v, int radius) { return opening.reaches(v, radius); }});
}

const SkeletonGraph& SpaceAnalysis::skeleton() {
  return get<SkeletonGraph>(skeleton_, skeleton_key(), [this] {
    const CubicalComplex thin = thin_space();
    if (input_.settings.node_radius == NodeRadius::corner)
      return build_graph(thin, distance(), pool_);
    if (input_.settings.node_radius == NodeRadius::chessboard) {
      const auto steps = chebyshev_distance(domain().voxels, pool_, input_.byte_limit());
      require_memory("a map of squared distances", steps.size(),
                     steps.count() * sizeof(std::uint32_t), input_.byte_limit());
      Grid3<std::uint32_t> squares(steps.size());
      for (std::size_t i = 0; i < steps.count(); ++i)
        squares[i] = std::uint32_t{steps[i]} * steps[i];
      return build_graph_by_voxels(thin, squares, pool_);
    }
    const auto squares = squared_distance(domain().voxels, pool_, input_.byte_limit());
    return build_graph_by_voxels(thin, squares, pool_);
  });
}

const FilteredSkeleton& SpaceAnalysis::filtered() {
  return get<FilteredSkeleton>(filtered_, filtered_key(), [this] {
    return input_.settings.node_radius == NodeRadius::chessboard
               ? filter_without_access(skeleton(), voxels().transform)
               : filter_skeleton(skeleton());
  });
}

Grid3<std::uint32_t> SpaceAnalysis::make_map(const SkeletonGraph& graph) {
  Grid3<std::uint32_t> map = lacuna::node_map(domain().voxels, graph, pool_, input_.byte_limit());
  if (input_.settings.mapping == NodeMapping::visible) {
    prefer_visible_nodes(map, graph, distance(), pool_);
  }
  return map;
}

const Grid3<std::uint32_t>& SpaceAnalysis::node_map() {
  if (!node_map_.value) {
    get<Grid3<std::uint32_t>>(node_map_, map_key(node_map_.type, skeleton_key()),
                              [this] { return make_map(skeleton()); });
    require_map(*node_map_.value, domain().voxels.size(), skeleton().nodes());
  }
  return *node_map_.value;
}

const Grid3<std::uint32_t>& SpaceAnalysis::filtered_map() {
  if (!filtered_map_.value) {
    get<Grid3<std::uint32_t>>(filtered_map_, map_key(filtered_map_.type, filtered_key()),
                              [this] { return make_map(filtered().graph); });
    require_map(*filtered_map_.value, domain().voxels.size(), filtered().graph.nodes());
  }
  return *filtered_map_.value;
}

const SimplifiedSkeleton& SpaceAnalysis::simplified() {
  return get<SimplifiedSkeleton>(simplified_, simplified_key(),
                                 [this] { return simplify_skeleton(skeleton()); });
}

const VisibilityClusters& SpaceAnalysis::clusters() {
  return get<VisibilityClusters>(clusters_, clusters_key(), [this] {
    return visibility_clusters(simplified(), input_.settings.cluster_alpha);
  });
}

const VisibilityGates& SpaceAnalysis::gates() {
  return get<VisibilityGates>(gates_, ArtefactKey(gates_.type, gates_version).from(clusters_key()),
                              [this] { return visibility_gates(simplified().graph, clusters()); });
}

const RegionLabels& SpaceAnalysis::regions() {
  return get<RegionLabels>(regions_, regions_key(), [this] {
    auto forest = [this] {
      const auto distance = chebyshev_distance(domain().voxels, pool_, input_.byte_limit());
      return opening_forest(distance, pool_, input_.byte_limit());
    };
    return input_.settings.regions == RegionLabelling::forest ? forest_labels(forest(), pool_)
                                                              : opening_labels(forest(), pool_);
  });
}

const Portals& SpaceAnalysis::portals() {
  return get<Portals>(portals_, ArtefactKey(portals_.type, portals_version).from(regions_key()),
                      [this] {
                        const RegionLabels& labels = regions();
                        return find_portals(labels, pool_, input_.byte_limit());
                      });
}

std::shared_ptr<const Octree> SpaceAnalysis::octree(double levels) {
  const ArtefactKey key = ArtefactKey("octree", octree_version, fmt::format("levels={}", levels))
                              .from("geometry", input_.geometry);
  return store_.get<Octree>(key, [&] {
    const TriangleSoup triangles = input_.triangles();  // before byte_limit(): it takes memory
    return surface_octree(triangles, levels, pool_, input_.byte_limit());
  });
}

Borders SpaceAnalysis::borders(BorderFaces which) {
  return find_borders(regions(), which, pool_, input_.byte_limit());
}

std::uint64_t SpaceAnalysis::complex_faces() { return closure_faces(domain().voxels); }

void SpaceAnalysis::close() {
  const auto note = [this](const auto&... parts) {
    ((parts.value ? void() : store_.not_needed(parts.type)), ...);
  };
  note(voxels_, domain_, skeleton_, filtered_, node_map_, filtered_map_, simplified_, clusters_,
       gates_, regions_, portals_);
}

}  // namespace lacuna
