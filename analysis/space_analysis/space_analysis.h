#pragma once

#include <functional>
#include <memory>
#include <string>

#include "analysis/artefacts/store.h"
#include "analysis/complex/curvilinear.h"
#include "analysis/geometry/triangle_soup.h"
#include "analysis/octree/octree.h"
#include "analysis/regions/borders.h"
#include "analysis/regions/forest_labels.h"
#include "analysis/regions/portals.h"
#include "analysis/settings/analysis_settings.h"
#include "analysis/skeleton/clusters.h"
#include "analysis/skeleton/filter.h"
#include "analysis/skeleton/gates.h"
#include "analysis/skeleton/simplify.h"
#include "analysis/space/domain.h"
#include "analysis/space/voxelize.h"

namespace lacuna {

/// What is analysed.
struct SpaceInput {
  std::function<TriangleSoup()> triangles;  ///< called only if the scene is voxelised now
  std::string geometry;                     ///< hash of the triangles, lower-case hexadecimal
  std::function<DomainSeeds()> seeds;       ///< which parts of the empty space matter
  AnalysisSettings settings;
  /// Of the memory that a step may take beside what is there already; asked before each.
  std::function<std::uint64_t()> byte_limit;
};

/// The shape of a scene's empty space. Each part is made or loaded when it is first asked for, with
/// all that it is made from, and then stays: what nobody asks for is never built. Not for use by
/// several threads at once; what was returned may be read by all. Every call may throw what
/// voxelize() throws, MemoryLimitError and WaitInterrupted.
class SpaceAnalysis {
 public:
  /// `store` and `pool` outlive it.
  SpaceAnalysis(SpaceInput input, ArtefactStore& store, const ThreadPool& pool);

  const Voxels& voxels();
  /// What of the empty space the seeds reach.
  const Domain& domain();
  /// L1 distance to all that is not in the domain. Not kept on disk: reading takes as long.
  const Grid3<std::uint16_t>& distance();
  const SkeletonGraph& skeleton();
  const FilteredSkeleton& filtered();
  /// Of every voxel of the domain its node of skeleton() (or filtered().graph), as
  /// AnalysisSettings::mapping says.
  const Grid3<std::uint32_t>& node_map();
  const Grid3<std::uint32_t>& filtered_map();
  const SimplifiedSkeleton& simplified();
  const VisibilityClusters& clusters();
  const VisibilityGates& gates();
  /// With the opening map (thesis 10.3.1) that they come from.
  const RegionLabels& regions();
  const Portals& portals();
  /// Of every region. Made anew at each call: reading takes as long.
  Borders borders(BorderFaces which);

  /// The scene's surfaces, `levels` in [0, Octree::most_levels] deep.
  std::shared_ptr<const Octree> octree(int levels);
  /// What others make for the nodes of filtered() and keep beside the parts: `type`, `version` and
  /// `settings` as ArtefactKey's, `scene` a hash of all else that it is made from (lower-case
  /// hexadecimal). `build` is told how many bytes it may take, and throws MemoryLimitError.
  template <class T>
  std::shared_ptr<const T> for_filtered(const char* type, std::uint32_t version,
                                        std::string settings, const std::string& scene,
                                        const std::function<T(std::uint64_t)>& build) {
    const ArtefactKey key = ArtefactKey(type, version, std::move(settings)).from(filtered_key());
    return store_.get<T>(ArtefactKey(key).from("scene", scene),
                         [&] { return build(input_.byte_limit()); });
  }

  /// Of the closure of the domain: what thinning starts from, and its cost grows with.
  std::uint64_t complex_faces();
  /// Notes in the store what was not asked for.
  void close();

 private:
  /// An artefact, or nothing yet, and what its type is called.
  template <class T>
  struct Part {
    const char* type;
    std::shared_ptr<const T> value = {};
  };
  template <class T>
  const T& get(Part<T>& part, const ArtefactKey& key, const std::function<T()>& build);
  /// Keys name all that the bits depend on: the domain's own voxels stand for scene
  /// and seeds, so two cameras in one room share what is made from it.
  ArtefactKey voxels_key() const;
  ArtefactKey domain_key(const DomainSeeds& seeds) const;
  ArtefactKey of_domain(const char* type, std::uint32_t version, std::string settings = {});
  ArtefactKey map_key(const char* type, const ArtefactKey& graph);
  ArtefactKey skeleton_key();
  ArtefactKey filtered_key();
  ArtefactKey simplified_key();
  ArtefactKey clusters_key();
  ArtefactKey regions_key();
  CubicalComplex thin_space();
  Grid3<std::uint32_t> make_map(const SkeletonGraph& graph);

  SpaceInput input_;
  ArtefactStore& store_;
  const ThreadPool& pool_;
  std::string domain_hash_;
  std::unique_ptr<Grid3<std::uint16_t>> distance_;
  Part<Voxels> voxels_{"voxels"};
  Part<Domain> domain_{"domain"};
  Part<SkeletonGraph> skeleton_{"skeleton"};
  Part<FilteredSkeleton> filtered_{"filtered_skeleton"};
  Part<Grid3<std::uint32_t>> node_map_{"node_map"}, filtered_map_{"filtered_map"};
  Part<SimplifiedSkeleton> simplified_{"simplified_skeleton"};
  Part<VisibilityClusters> clusters_{"visibility_clusters"};
  Part<VisibilityGates> gates_{"visibility_gates"};
  Part<RegionLabels> regions_{"regions"};
  Part<Portals> portals_{"portals"};
};

}  // namespace lacuna
