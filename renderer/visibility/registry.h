#pragma once

#include "renderer/visibility/cached_visibility.h"
#include "renderer/visibility/gate_visibility.h"
#include "renderer/visibility/node_map_visibility.h"
#include "renderer/visibility/plain_visibility.h"
#include "renderer/visibility/probabilistic_visibility.h"
#include "renderer/visibility/roulette_visibility.h"
#include "renderer/visibility/view_map_visibility.h"
#include "renderer/visibility/visibility.h"

namespace lacuna {

/// All visibility strategies. A new strategy is a row here and an alternative of
/// VisibilitySettings.
using VisibilityRegistry = Registry<Entry<ExactVisibilitySettings, ExactVisibility>,
                                    Entry<NoVisibilitySettings, NoVisibility>,
                                    Entry<RouletteVisibilitySettings, RouletteVisibility>,
                                    Entry<ProbabilisticVisibilitySettings, ProbabilisticVisibility>,
                                    Entry<InterpolatedVisibilitySettings, InterpolatedVisibility>,
                                    Entry<GatesVisibilitySettings, GateVisibility>,
                                    Entry<NodeMapsVisibilitySettings, NodeMapVisibility>,
                                    Entry<ViewMapsVisibilitySettings, ViewMapVisibility>>;

static_assert(std::is_same_v<VisibilityRegistry::Settings, VisibilitySettings>,
              "the registry and the settings list the same choices in the same order");

}  // namespace lacuna
