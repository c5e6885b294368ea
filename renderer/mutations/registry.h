#pragma once

#include "renderer/mutations/path_space.h"
#include "renderer/mutations/primary_sample.h"
#include "renderer/path/strategy.h"

namespace lacuna {

/// All mutations. A new mutation is a row here and an alternative of MutationSettings.
using MutationRegistry = Registry<Entry<MultiplexedSettings, MultiplexedMutation>,
                                  Entry<PrimarySampleSettings, PrimarySampleMutation>,
                                  Entry<PathSpaceSettings, PathSpaceMutation>>;

static_assert(std::is_same_v<MutationRegistry::Settings, MutationSettings>,
              "the registry and the settings list the same choices in the same order");

}  // namespace lacuna
