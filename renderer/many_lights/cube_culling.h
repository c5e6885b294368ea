#pragma once

#include <optional>

#include "renderer/many_lights/vpl_set.h"
#include "renderer/view_maps/view_tree.h"

namespace lacuna {

/// Culls virtual lights for cubes of the scene (Kol et al. 2018, 5.1): the octrees of the scene and
/// of the lights are traversed together, as for the maps of all lights, down to a coarse level of
/// both. A pair of nodes is culled if no point of the scene node's sphere lies in front of a light
/// of the other (Fig. 4), or if all lights are further from it than the cutoff. Lights at infinity
/// are never culled.
class CubeCulling {
 public:
  static constexpr int levels = 6;  ///< of both octrees, as in the paper

  /// `scene`: of `levels` levels. `cutoff`: scene units; 0: none. The references must outlive this.
  CubeCulling(const VplSet& lights, const Octree& scene, float cutoff, const ThreadPool& pool);

  /// The leaves of the lights' octree that are left for the cube of a point: one bit each; none for
  /// a point in no cube of the scene, for which all are left.
  std::optional<std::span<const std::uint64_t>> left(const V3f& x) const;
  /// Number of leaves; the last one has the lights at infinity.
  std::size_t leaves() const { return first_.size() - 1; }
  /// The lights of a leaf, by their number in the order of blocks.
  std::span<const std::uint32_t> lights_of(std::size_t leaf) const {
    return {lights_.data() + first_[leaf], lights_.data() + first_[leaf + 1]};
  }
  /// Fraction of all pairs of a cube and a leaf that were culled.
  double culled() const;
  /// Number of pairs of nodes that were tested.
  std::uint64_t pairs() const { return pairs_; }

 private:
  void cull_below(std::uint32_t scene_node, std::vector<std::uint32_t> waiting,
                  std::uint64_t& pairs);
  bool culled(std::uint32_t scene_node, std::uint32_t view_node) const;

  const Octree& scene_;
  float cutoff_;
  std::optional<ViewTree> views_;
  std::vector<std::uint32_t> lights_, first_;  // by leaf
  std::size_t words_;                          // of the bits of a cube
  std::vector<std::uint64_t> left_;            // by cube
  std::uint64_t pairs_ = 0;
};

}  // namespace lacuna
