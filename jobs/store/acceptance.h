#pragma once

#include <cstdint>
#include <string>

#include "base/settings/field.h"

namespace lacuna {

/// accepted.json: what a service took the job for, written once into its folder, so that a job
/// whose database is lost can be taken over again.
struct Acceptance {
  std::int64_t number = 0;
  std::string created = {};
  std::string sweep = {};
  std::string shards = {};
  std::string idempotency_key = {};
  std::string body_hash = {};
  bool operator==(const Acceptance&) const = default;
};
template <class V>
void describe(V& v, Acceptance& s) {
  v("number", s.number, {.doc = "the order in which jobs were accepted"});
  v("created", s.created, {.doc = "when, UTC, ISO 8601", .max = 32});
  v("sweep", s.sweep, {.doc = "that it is a run of; empty: none", .max = 64});
  v("shards", s.shards,
    {.doc = "the sweep whose runs are its shards, which it is merged from; empty: none",
     .max = 64});
  v("idempotency_key", s.idempotency_key, {.doc = "the poster's own name for it", .max = 128});
  v("body_hash", s.body_hash, {.doc = "of the posted text, in hexadecimal", .max = 32});
}

}  // namespace lacuna
