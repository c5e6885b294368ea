#pragma once

#include <cstddef>

#include "jobs/queue/store.h"

namespace lacuna {

struct Imported {
  std::size_t jobs = 0, sweeps = 0;
};

/// Takes over the jobs and sweeps whose folders lie in `data` into a store that has none: of
/// version 0.1, which had no database, or after a database was lost. Their states, order, keys and
/// sweeps are kept; what only a database knew is not (priorities and holds that were changed). A
/// damaged folder is taken over as failed. All or nothing: throws std::system_error if a folder
/// cannot be read now. Does nothing if the store has taken over its folders before.
Imported import_folders(Store& store, const DataRoot& data);

}  // namespace lacuna
