#pragma once

#include <cstddef>

#include "jobs/queue/store.h"

namespace lacuna {

struct Imported {
  std::size_t jobs = 0, sweeps = 0;
};

/// Imports the jobs and sweeps whose folders lie in `data` into an empty store: from version 0.1,
/// which had no database, or after the loss of a database. Keeps their states, order, keys and
/// sweeps, but not what only a database stores (changed priorities and holds). A damaged folder is
/// imported as failed. All or nothing: throws std::system_error if a folder cannot be read now.
/// Does nothing if the store has imported its folders before.
Imported import_folders(Store& store, const DataRoot& data);

}  // namespace lacuna
