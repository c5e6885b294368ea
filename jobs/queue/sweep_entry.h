#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "jobs/sweep/sweep_state.h"

namespace lacuna {

/// One sweep of a queue: a row of the table of sweeps.
struct SweepEntry {
  std::int64_t number = 0;  ///< order of acceptance; set by the store
  std::string id, label;
  SweepStage state = SweepStage::running;
  std::string created, finished;   ///< as in JobState
  std::size_t runs = 0;            ///< of the whole sweep
  std::optional<std::string> key;  ///< Idempotency-Key of the client
  std::string body_hash;           ///< of the posted text, hexadecimal
  std::string spec;                ///< sweep.json
  std::string error;               ///< why it `failed`
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
