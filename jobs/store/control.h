#pragma once

#include <cstdint>
#include <string>

#include "analysis/settings/field.h"

namespace lacuna {

/// queue.json: clients' requests for a job that the service must remember. Only the service writes
/// it.
struct JobControl {
  int priority = 0;
  bool held = false;
  bool cancel = false;
  int crashes = 0;
  std::int64_t renderer_pid = 0;
  std::int64_t renderer_start = 0;
  std::string renderer_boot;
  std::string idempotency_key;
  std::string body_hash;
  std::string shards;
  bool operator==(const JobControl&) const = default;
};
inline constexpr int max_priority = 100;
template <class V>
void describe(V& v, JobControl& s) {
  v("priority", s.priority,
    {.doc = "higher is rendered earlier", .min = -max_priority, .max = max_priority});
  v("held", s.held, {.doc = "does not start, or go on, until it is released"});
  v("cancel", s.cancel, {.doc = "a person has asked to stop it for good"});
  v("crashes", s.crashes, {.doc = "renderers of it that crashed", .min = 0});
  v("renderer_pid", s.renderer_pid, {.doc = "the latest renderer's process; 0: none", .min = 0});
  v("renderer_start", s.renderer_start,
    {.doc = "when that process began, in clock ticks since the machine did", .min = 0});
  v("renderer_boot", s.renderer_boot, {.doc = "the kernel's name of that boot", .max = 64});
  v("idempotency_key", s.idempotency_key, {.doc = "the poster's own name for it", .max = 128});
  v("body_hash", s.body_hash, {.doc = "of the posted text, in hexadecimal", .max = 32});
  v("shards", s.shards,
    {.doc = "the sweep whose runs are its shards, which it is merged from; empty: none",
     .max = 64});
}

}  // namespace lacuna
