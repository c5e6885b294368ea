#include "renderer/guides/skeleton_to_eye.h"

#include <algorithm>

#include "renderer/guides/arriving_power.h"
#include "renderer/guides/skeleton_lobes.h"

namespace lacuna {

void SkeletonToEye::prepare(const PrepareContext& context) {
  lookup_.emplace(context.space.voxels().transform, context.space.node_map());
  const std::vector<double> importance =
      arriving_importance(context.scene, context.camera, *lookup_, context.space.skeleton().nodes(),
                          settings_.eye_rays, context.pool);
  seen_nodes_ = static_cast<std::size_t>(
      std::count_if(importance.begin(), importance.end(), [](double f) { return f > 0; }));
  lobes_ = skeleton_lobes(context, importance, settings_.aim);
}

std::vector<std::pair<std::string, double>> SkeletonToEye::statistics() const {
  const auto guided =
      std::count_if(lobes_.begin(), lobes_.end(), [](const LobeSet& l) { return !l.empty(); });
  return {{"nodes", static_cast<double>(lobes_.size())},
          {"seen_nodes", static_cast<double>(seen_nodes_)},
          {"guided_nodes", static_cast<double>(guided)}};
}

}  // namespace lacuna
