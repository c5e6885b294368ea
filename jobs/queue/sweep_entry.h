#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "jobs/sweep/sweep_state.h"

namespace lacuna {

/// All that is known of one sweep of a queue: a row of the table of sweeps.
struct SweepEntry {
  std::int64_t number = 0;  ///< the order in which sweeps were accepted; the store gives it
  std::string id, label;
  SweepStage state = SweepStage::running;
  std::string created, finished;   ///< as in JobState
  std::size_t runs = 0;            ///< of the whole sweep
  std::optional<std::string> key;  ///< the poster's own name for it
  std::string body_hash;           ///< of the posted text, in hexadecimal
  std::string spec;                ///< sweep.json
  std::string error;               ///< of `failed`: why
};

/// The columns of the table.
template <class V>
void describe(V& v, SweepEntry& e) {
  v("number", e.number, {});
  v("id", e.id, {});
  v("label", e.label, {});
  v("state", e.state, {});
  v("created", e.created, {});
  v("finished", e.finished, {});
  v("runs", e.runs, {});
  v("key", e.key, {});
  v("body_hash", e.body_hash, {});
  v("spec", e.spec, {});
  v("error", e.error, {});
}

}  // namespace lacuna
