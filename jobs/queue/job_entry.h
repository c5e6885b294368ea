#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// One job of a queue: a row of the table of jobs and, while its renderer runs, the progress that
/// it last wrote.
struct JobEntry {
  std::int64_t number = 0;    ///< the order in which jobs were accepted; the store gives it
  std::int64_t revision = 0;  ///< number of the latest change; the store gives it
  std::string id, label, scene, integrator, reference;
  std::string sweep;   ///< that it is a run of; empty: none
  std::string shards;  ///< the sweep whose runs it is merged from; empty: none
  bool exclusive = false;
  JobState state;
  int priority = 0;
  bool held = false;      ///< does not start, or go on, until it is released
  bool cancel = false;    ///< a person has asked to stop it for good
  bool reopened = false;  ///< what its folder says of an end is of before it was opened again
  bool begun = false;     ///< a renderer was started for it, or it was submitted, and has not ended
  int crashes = 0;        ///< renderers of it that crashed
  std::optional<std::string> key;  ///< the poster's own name for it
  std::string body_hash;           ///< of the posted text, in hexadecimal
  std::string spec;                ///< job.json
  std::string obstacle;            ///< what keeps it from going on, and may pass; empty: nothing
  std::optional<Progress> progress;
  bool pictured = false;            ///< image.png is there
  std::int64_t renderer_pid = 0;    ///< the latest renderer's process; 0: none
  std::int64_t renderer_start = 0;  ///< when that began, in clock ticks since the machine did
  std::string renderer_boot;        ///< the kernel's name of that boot
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

/// What of a job's settings the queue looks at.
void take_spec(JobEntry& entry, const JobSpec& spec);

/// Whether the job's image.png is there.
bool has_picture(const JobFolder& folder);

}  // namespace lacuna
