#pragma once

#include <memory>
#include <optional>

#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/geometry_clusters.h"
#include "renderer/visibility/skeleton_node.h"
#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// visibility: gates (Noel 2015, ch. 7). A light illuminates all of its own visibility cluster, and
/// other clusters through the disks between its cluster and theirs, without occlusion beyond the
/// disks, or not at all (GatesVisibilitySettings::through_gates). Lights and points without a
/// cluster are tested by shadow rays. Decisions that the thesis leaves open:
/// - The cone of a light and a gate has the disk as its base, at any angle.
/// - Clusters are those of a tile of pixels, which are gathered together, so that lists are short.
/// - Where the cones of several gates overlap, the largest value is used, so V <= 1.
class GateVisibility : public VisibilityBase {
 public:
  static constexpr bool needs_space() { return true; }
  static constexpr float guess_cost = 0.05F;  // measured on door (docs)

  explicit GateVisibility(const GatesVisibilitySettings& settings) : settings_(settings) {}

  void prepare(const PrepareContext& context);
  std::uint32_t group(const VplGeometry& light) const { return clusters_->of(light); }
  std::uint64_t groups() const { return clusters_->count(); }
  Counters begin(const LightPass& pass);
  struct At {
    V3f x;
    std::uint32_t cluster;
    std::shared_ptr<GeometryClusters> shared = nullptr;  // GateTests::clusters only
    std::uint32_t geometry = 0;                          // of `shared`
  };
  At at(const ShadingPoint& point, const IterationContext&) const {
    return {point.vertex->surface.x, clusters_->of(point)};
  }
  /// Divides the points that are gathered together into geometry clusters.
  void share(std::span<const ShadingPoint> points, std::span<At> states,
             const IterationContext& context) const;
  /// Whether the lights belong to another cluster, and gates are disabled or no cone of a light
  /// meets the point's geometry cluster.
  bool hides(const At& at, std::size_t block) const {
    const std::uint32_t cluster = cluster_of_block_[block];
    if (cluster == at.cluster || cluster == no_group || at.cluster == no_group) return false;
    return !settings_.through_gates || (at.shared && lists_none(at, block));
  }
  /// Requires hides(at, block) == false.
  void decide(const At& at, std::size_t block, const Terms& terms, VisibilityEstimate& d) const;
  std::vector<std::pair<std::string, double>> statistics() const;

 private:
  struct Gate {
    V3f centre, axis;  // scene units; unit length
    float radius2;
  };

  /// The list of a point's geometry cluster for a block of lights of another cluster (7.3.3).
  const std::vector<GeometryCluster::Listed>& listed(const At& at, std::size_t block) const;
  /// Whether that list is empty; counts its tests.
  bool lists_none(const At& at, std::size_t block) const;
  Float8 through(const Gate& gate, const Float8x3& to_gate, const Float8x3& w) const;

  GatesVisibilitySettings settings_;
  std::optional<ClusterLookup> clusters_;
  std::vector<std::uint32_t> first_;  // of each cluster: first index in gates_; and the end
  std::vector<Gate> gates_;           // each gate once for each of its two clusters
  const VplSet* lights_ = nullptr;
  std::vector<std::uint32_t> cluster_of_block_;
  mutable GateTestCounts counts_;
};

}  // namespace lacuna
