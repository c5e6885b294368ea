#include "analysis/skeleton/clusters.h"

#include <fmt/format.h>

#include <stdexcept>

#include "analysis/skeleton/by_radius.h"

namespace lacuna {
namespace {

class Growth {
 public:
  Growth(const SimplifiedSkeleton& skeleton, double alpha)
      : graph_(skeleton.graph), kinds_(skeleton.kinds), alpha_(alpha) {
    clusters_.of_node.assign(graph_.nodes(), no_node);
  }

  VisibilityClusters all() {
    for (const std::uint32_t start : by_falling_radius(graph_))
      if (is_free(start)) grow(start);
    return std::move(clusters_);
  }

 private:
  bool is_free(std::uint32_t n) const { return clusters_.of_node[n] == no_node; }
  void take(std::uint32_t n) {
    clusters_.of_node[n] = clusters_.count;
    queue_.push_back(n);
  }

  void grow(std::uint32_t start) {
    // Starts at the free node of largest radius.
    const double least = (1 - alpha_) * static_cast<double>(graph_.radii[start]);
    queue_.clear();
    take(start);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const std::uint32_t n = queue_[i];
      if (n != start && kinds_[n] == NodeKind::curvature) continue;
      for (const std::uint32_t m : graph_.of(n))
        if (is_free(m) && kinds_[m] != NodeKind::curvature &&
            static_cast<double>(graph_.radii[m]) >= least)
          take(m);
      take_ball(n);
    }
    ++clusters_.count;
  }
  /// The free nodes that are accessible in the ball of `centre`.
  void take_ball(std::uint32_t centre) {
    path_.assign(1, centre);
    while (!path_.empty()) {
      const std::uint32_t n = path_.back();
      path_.pop_back();
      for (const std::uint32_t m : graph_.of(n)) {
        if (!is_free(m) || !graph_.in_ball(m, centre)) continue;
        take(m);
        path_.push_back(m);
      }
    }
  }

  const SkeletonGraph& graph_;
  const std::vector<NodeKind>& kinds_;
  const double alpha_;
  VisibilityClusters clusters_;
  std::vector<std::uint32_t> queue_;  // the cluster that grows
  std::vector<std::uint32_t> path_;
};

}  // namespace

VisibilityClusters visibility_clusters(const SimplifiedSkeleton& skeleton, double alpha) {
  if (!(alpha >= 0 && alpha <= 1))
    throw std::invalid_argument(
        fmt::format("alpha of visibility clusters is {}: 0 to 1 is allowed", alpha));
  return Growth(skeleton, alpha).all();
}

}  // namespace lacuna
