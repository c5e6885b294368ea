#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "base/settings/field.h"

namespace lacuna {

/// The state of a sweep of a service.
enum class SweepStage { running, cancelling, done, cancelled, failed };

template <>
struct EnumTable<SweepStage> {
  static constexpr std::array<EnumValue<SweepStage>, 5> values{{
      {SweepStage::running, "running", "some of its runs are not over, or not created yet"},
      {SweepStage::cancelling, "cancelling", "no more runs are created, and existing ones stop"},
      {SweepStage::done, "done", "every run is over: done, failed or cancelled"},
      {SweepStage::cancelled, "cancelled", "it was stopped on request"},
      {SweepStage::failed, "failed", "its folder cannot be read"},
  }};
};

/// done, cancelled, failed: no more runs are started.
inline bool is_over(SweepStage s) {
  return s != SweepStage::running && s != SweepStage::cancelling;
}

/// state.json of a sweep of a service, for people and in case its database is lost. Times are as in
/// JobState.
struct SweepState {
  SweepStage state = SweepStage::running;
  std::string created = {}, finished = {};
  std::size_t runs = 0;  ///< of the whole sweep: determines their jobs' ids without expanding it
  std::string idempotency_key = {}, body_hash = {};
  bool operator==(const SweepState&) const = default;
};
template <class V>
void describe(V& v, SweepState& s) {
  v("state", s.state, {.doc = "state of the sweep", .required = true});
  v("created", s.created, {.doc = "UTC, ISO 8601", .required = true});
  v("finished", s.finished, {.doc = "UTC, ISO 8601; empty: not yet"});
  v("runs", s.runs, {.doc = "number of runs", .min = 1, .required = true});
  v("idempotency_key", s.idempotency_key, {.doc = "Idempotency-Key of the client", .max = 128});
  v("body_hash", s.body_hash, {.doc = "of the posted text, in hexadecimal", .max = 32});
}

}  // namespace lacuna
