#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// One job of a queue: a row of the table of jobs and, while its renderer runs, its latest
/// progress.
struct JobEntry {
  std::int64_t number = 0;    ///< order of acceptance; set by the store
  std::int64_t revision = 0;  ///< number of the latest change; set by the store
  std::string id, label, scene, integrator, reference;
  std::string sweep;   ///< whose run it is; empty: none
  std::string shards;  ///< the sweep whose runs it is merged from; empty: none
  bool exclusive = false;
  JobState state;
  int priority = 0;
  bool held = false;               ///< does not start or continue until it is released
  bool cancel = false;             ///< its cancellation was requested
  bool reopened = false;           ///< an end recorded in its folder precedes its reopening
  bool begun = false;              ///< a renderer was started or submitted for it and has not ended
  int crashes = 0;                 ///< number of its renderers that crashed
  std::optional<std::string> key;  ///< Idempotency-Key of the client
  std::string body_hash;           ///< of the posted text, hexadecimal
  std::string spec;                ///< job.json
  std::string obstacle;            ///< transient reason why it does not continue; empty: none
  std::optional<Progress> progress;
  bool pictured = false;            ///< image.png exists
  std::int64_t renderer_pid = 0;    ///< the latest renderer's process; 0: none
  std::int64_t renderer_start = 0;  ///< its start, in clock ticks since boot
  std::string renderer_boot;        ///< the kernel's identifier of that boot
  std::string place;                ///< where its renderer runs or waits; not stored

  bool over() const { return is_terminal(state.state); }
  bool operator==(const JobEntry&) const = default;
};
using EntryPtr = std::shared_ptr<const JobEntry>;

/// The columns of the table.
template <class V>
void describe(V& v, JobEntry& e) {
  v("number", e.number, {});
  v("revision", e.revision, {});
  v("id", e.id, {});
  v("label", e.label, {});
  v("scene", e.scene, {});
  v("integrator", e.integrator, {});
  v("reference", e.reference, {});
  v("sweep", e.sweep, {});
  v("shards", e.shards, {});
  v("exclusive", e.exclusive, {});
  describe(v, e.state);
  v("priority", e.priority, {});
  v("held", e.held, {});
  v("cancel", e.cancel, {});
  v("reopened", e.reopened, {});
  v("begun", e.begun, {});
  v("crashes", e.crashes, {});
  v("key", e.key, {});
  v("body_hash", e.body_hash, {});
  v("spec", e.spec, {});
  v("obstacle", e.obstacle, {});
  v("progress", e.progress, {});
  v("pictured", e.pictured, {});
  v("renderer_pid", e.renderer_pid, {});
  v("renderer_start", e.renderer_start, {});
  v("renderer_boot", e.renderer_boot, {});
}

/// Sets the fields of `entry` that follow from the job's settings.
void take_spec(JobEntry& entry, const JobSpec& spec);

/// Whether the job's image.png exists.
bool has_picture(const JobFolder& folder);

}  // namespace lacuna
