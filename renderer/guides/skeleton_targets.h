#pragma once

#include <span>
#include <vector>

#include "renderer/guides/importance_points.h"
#include "renderer/guides/lobe_set.h"
#include "renderer/path/contexts.h"

namespace lacuna {

/// For each of `nodes` of the skeleton, the targets of its lobes: its importance points (Noel 2015,
/// 9.2, 9.3). `importance`: f of each node (eq. 164).
std::vector<std::vector<Target>> skeleton_targets(const PrepareContext& context,
                                                  std::span<const double> importance,
                                                  ImportanceAim aim,
                                                  std::span<const std::uint32_t> nodes);

}  // namespace lacuna
