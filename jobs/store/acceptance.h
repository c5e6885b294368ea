#pragma once

#include <cstdint>
#include <string>

#include "base/settings/field.h"

namespace lacuna {

/// accepted.json: data of a service about the job, written once into its folder, so that the job
/// can be imported if the database is lost.
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
  v("sweep", s.sweep, {.doc = "whose run it is; empty: none", .max = 64});
  v("shards", s.shards,
    {.doc = "the sweep whose runs are the shards it is merged from; empty: none", .max = 64});
  v("idempotency_key", s.idempotency_key, {.doc = "Idempotency-Key of the client", .max = 128});
  v("body_hash", s.body_hash, {.doc = "of the posted text, in hexadecimal", .max = 32});
}

}  // namespace lacuna
