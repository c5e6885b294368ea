#pragma once

#include <span>
#include <vector>

#include "renderer/core/key_sort.h"
#include "renderer/path/vertex.h"

namespace lacuna {

/// A vertex of a finished eye path and the light that arrived there: what guides learn from.
struct TrainingSample {
  GuidingCell cell;    ///< with the probability with which the path followed the distribution
  V3f x;               ///< scene units
  V3f n;               ///< unit; the geometric normal on the side of the previous vertex
  V3f w{0, 0, 0};      ///< unit; the direction in which the path went on
  float distance = 0;  ///< to the next vertex, scene units; infinite to the background
  float cosine = 0;    ///< |w . n_s|, with the shading normal
  float pdf = 0;       ///< of `w`, per steradian; 0: the path ended, or left by a delta lobe
  float bsdf_pdf = 0;  ///< density of `w` by the BSDF alone
  float radiance = 0;  ///< luminance from `w`, as estimated by the rest of the path
  /// Luminance of the path's contributions at later vertices, over that of its throughput here.
  float reflected = 0;
};

/// The training samples of a pass of an iteration, sorted by cell; within a cell in the order of
/// the parts, so that the learned state has the same bits for any number of threads.
class TrainingSamples {
 public:
  using Part = std::vector<TrainingSample>;

  /// `share`: the part of an iteration that the samples come from.
  TrainingSamples(std::span<const Part> parts, std::size_t cells, const ThreadPool& pool,
                  double share = 1);

  double share() const { return share_; }

  std::size_t size() const { return sorted_.size(); }
  std::span<const TrainingSample> of(std::size_t cell) const {
    const std::span<const std::uint32_t> first = sort_.starts();
    return all().subspan(first[cell], first[cell + 1] - first[cell]);
  }
  /// Those of all cells, and of vertices without one.
  std::span<const TrainingSample> all() const { return {sorted_.begin(), sorted_.end()}; }

 private:
  KeySort<const TrainingSample*> sort_;  // by cell; those without one have the last key
  HugeArray<TrainingSample> sorted_;
  double share_;
};

}  // namespace lacuna
