#pragma once

#include <span>
#include <vector>

#include "renderer/guides/importance_points.h"
#include "renderer/guides/lobe_set.h"
#include "renderer/path/contexts.h"

namespace lacuna {

/// Of each node of the skeleton, lobes around its importance points (Noel 2015, 9.2, 9.3).
/// `importance`: f of each node (eq. 164).
std::vector<LobeSet> skeleton_lobes(const PrepareContext& context,
                                    std::span<const double> importance, ImportanceAim aim);

}  // namespace lacuna
