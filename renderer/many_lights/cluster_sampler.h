#pragma once

#include <functional>

#include "renderer/many_lights/vpl_sampler.h"
#include "renderer/many_lights/vpl_tree.h"

namespace lacuna {

/// gather: clusters. Samples a few virtual lights for each shading point, by importance: a cut
/// through the light trees serves the points of a tile; a node of the cut is chosen for a point by
///
///   P = (1 - e) w / sum w + e I / sum I,   w = I G sqrt(r)
///
/// and a light of the node in proportion to its intensity. I is the node's intensity, G an estimate
/// of its geometric term, which is 0 only if none of its lights illuminates the point, and r the
/// learned rate of visibility between the cell of the point and that of the node's middle light: of
/// sampling the product of I G and a visibility that is 1 with probability r, w minimises the
/// variance. Contributions are divided by the probability, so the estimate is unbiased for any r.
class ClusterSampler {
 public:
  using Sample = VplSampler::Sample;
  /// r: the cells of shading points, and the rate of a cell and a block of lights, above 0.
  struct Rates {
    std::span<const std::uint32_t> cells;
    std::function<float(std::uint32_t cell, std::size_t block)> of;
  };

  /// The references must outlive this.
  ClusterSampler(const VplContributions& terms, const VplTree& tree,
                 const ClusterLightsSettings& settings)
      : terms_(terms), tree_(tree), settings_(settings) {}

  /// Samples lights for at most Lanes::size `points`; the result is sorted by block, then by point.
  std::vector<Sample> sample(std::span<const ShadingPoint> points, const IterationContext& context,
                             const Rates& rates) const;

 private:
  /// A node of the cut of a tile.
  struct Entry {
    std::uint32_t node;
    double gain;    // of dividing it
    Lanes weights;  // w of each point
  };
  struct Tile;
  Entry weigh(std::uint32_t node, const Tile& tile) const;
  std::vector<Entry> cut(const Tile& tile) const;
  void sample_for(const ShadingPoint& at, std::size_t point, std::span<const Entry> cut,
                  const IterationContext& context, std::vector<Sample>& samples) const;

  const VplContributions& terms_;
  const VplTree& tree_;
  ClusterLightsSettings settings_;
};

}  // namespace lacuna
