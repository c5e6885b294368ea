#pragma once

#include <functional>
#include <memory>
#include <string>

#include "analysis/artefacts/store.h"
#include "analysis/complex/curvilinear.h"
#include "analysis/geometry/triangle_soup.h"
#include "analysis/octree/octree.h"
#include "analysis/regions/borders.h"
#include "analysis/regions/opening_labels.h"
#include "analysis/regions/portals.h"
#include "analysis/settings/analysis_settings.h"
#include "analysis/skeleton/clusters.h"
#include "analysis/skeleton/filter.h"
#include "analysis/skeleton/gates.h"
#include "analysis/skeleton/simplify.h"
#include "analysis/space/domain.h"
#include "analysis/space/voxelize.h"

namespace lacuna {

/// The inputs of the analysis.
struct SpaceInput {
  std::function<TriangleSoup()> triangles;  ///< called only if the scene has to be voxelised
  std::string geometry;                     ///< hash of the triangles, lower-case hexadecimal
  std::function<DomainSeeds()> seeds;       ///< which parts of the empty space matter
  AnalysisSettings settings;
  /// Additional memory that a step may allocate; called before each step.
  std::function<std::uint64_t()> byte_limit;
};

/// The shape of a scene's empty space. Each artefact is built or loaded on its first request,
/// together with its inputs, and then stays in memory; artefacts that are never requested are never
/// built. Not thread-safe; the returned objects may be read by all threads. Every call may throw
/// the exceptions of voxelize(), MemoryLimitError, WaitInterrupted and Stopped.
class SpaceAnalysis {
 public:
  /// `store` and `pool` must outlive it.
  SpaceAnalysis(SpaceInput input, ArtefactStore& store, const ThreadPool& pool);

  const Voxels& voxels();
  /// The part of the empty space that the seeds reach.
  const Domain& domain();
  /// L1 distance to the complement of the domain. Not cached on disk: loading would take as long.
  const Grid3<std::uint16_t>& distance();
  const SkeletonGraph& skeleton();
  const FilteredSkeleton& filtered();
  /// The node of skeleton() (or filtered().graph) of every voxel of the domain, by
  /// AnalysisSettings::mapping.
  const Grid3<std::uint32_t>& node_map();
  const Grid3<std::uint32_t>& filtered_map();
  const SimplifiedSkeleton& simplified();
  const VisibilityClusters& clusters();
  const VisibilityGates& gates();
  /// The regions, with the opening map (thesis 10.3.1) that they are computed from.
  const RegionLabels& regions();
  const Portals& portals();
  /// The borders of all regions. Computed at each call: loading would take as long.
  Borders borders(BorderFaces which);

  /// The octree of the scene's surfaces with `levels` in [0, Octree::most_levels].
  std::shared_ptr<const Octree> octree(double levels);
  /// An artefact of another module, computed for the nodes of filtered(). `type`, `version` and
  /// `settings`: as for ArtefactKey; `scene`: a hash (lower-case hexadecimal) of all its other
  /// inputs. `build(byte_limit)` computes it and throws MemoryLimitError.
  template <class T>
  std::shared_ptr<const T> for_filtered(const char* type, std::uint32_t version,
                                        std::string settings, const std::string& scene,
                                        const std::function<T(std::uint64_t)>& build) {
    const ArtefactKey key = ArtefactKey(type, version, std::move(settings)).from(filtered_key());
    return store_.get<T>(ArtefactKey(key).from("scene", scene),
                         [&] { return build(input_.byte_limit()); });
  }

  /// Number of faces of the closure of the domain, from which thinning starts; its cost is
  /// proportional to it.
  std::uint64_t complex_faces();
  /// Records in the store the artefacts that were not requested.
  void close();

 private:
  /// An artefact, null until requested, and the name of its type.
  template <class T>
  struct Part {
    const char* type;
    std::shared_ptr<const T> value = {};
  };
  template <class T>
  const T& get(Part<T>& part, const ArtefactKey& key, const std::function<T()>& build);
  /// Keys contain everything that the bits depend on: the domain's own voxels represent scene and
  /// seeds, so two cameras in one room share all artefacts of its domain.
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
