#pragma once

#include "renderer/connections/connections.h"
#include "renderer/connections/hybrid_connections.h"
#include "renderer/connections/probabilistic_connections.h"
#include "renderer/connections/uniform_connections.h"

namespace lacuna {

/// All connection strategies. A new strategy is a row here and an alternative of
/// ConnectionsSettings.
using ConnectionsRegistry =
    Registry<Entry<PairedSettings, PairedConnections>, Entry<UniformSettings, UniformConnections>,
             Entry<SkeletonConnectionsSettings, SkeletonConnections>,
             Entry<ImportanceCacheSettings, ImportanceCacheConnections>,
             Entry<ProbabilisticConnectionsSettings, ProbabilisticConnections>,
             Entry<HybridSettings, HybridConnections>>;

static_assert(std::is_same_v<ConnectionsRegistry::Settings, ConnectionsSettings>,
              "the registry and the settings list the same choices in the same order");

}  // namespace lacuna
