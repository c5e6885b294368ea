#include "jobs/queue/import_folders.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "base/storage/atomic_file.h"
#include "base/storage/passing_error.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/store/own_document.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {
namespace {

/// queue.json of version 0.1: the requests of clients.
struct OldControl {
  int priority = 0;
  bool held = false;
  bool cancel = false;
  int crashes = 0;
  std::int64_t renderer_pid = 0;
  std::int64_t renderer_start = 0;
  std::string renderer_boot, idempotency_key, body_hash, shards;
};
template <class V>
void describe(V& v, OldControl& s) {
  v("priority", s.priority, {});
  v("held", s.held, {});
  v("cancel", s.cancel, {});
  v("crashes", s.crashes, {});
  v("renderer_pid", s.renderer_pid, {});
  v("renderer_start", s.renderer_start, {});
  v("renderer_boot", s.renderer_boot, {});
  v("idempotency_key", s.idempotency_key, {});
  v("body_hash", s.body_hash, {});
  v("shards", s.shards, {});
}

/// Reads parts of a folder; the first failure is recorded as its damage.
class Reading {
 public:
  /// Throws transient errors.
  template <class Read>
  void try_to(Read&& read) {
    try {
      read();
    } catch (const std::exception& error) {
      if (may_pass(error)) throw;
      if (damage_.empty()) damage_ = error.what();
    }
  }
  const std::string& damage() const { return damage_; }

 private:
  std::string damage_;
};

void set_state(JobEntry& job, const std::string& damage) {
  if (!damage.empty()) {
    job.state.state = State::failed;
    job.state.error = fmt::format("the job's folder cannot be read: {}", damage);
  } else if (!is_terminal(job.state.state)) {
    job.begun = job.state.state == State::running || job.state.state == State::interrupted;
    if (job.state.state == State::cancelling) job.cancel = true;
    job.state.state = job.held ? State::held : State::queued;
    if (job.cancel) job.state.state = State::cancelled;
    if (job.over()) job.begun = false;
  }
}

/// A job and its order.
struct Found {
  JobEntry job;
  std::int64_t number = 0;  // of its acceptance; 0: by version 0.1
  auto order() const { return std::tie(number, job.state.created, job.id); }
};

Found read_job(const JobFolder& folder) {
  Found found;
  JobEntry& job = found.job;
  job.id = folder.id();
  Reading reading;
  reading.try_to([&] {
    const auto path = folder.file("queue.json");
    if (is_gone(path)) return;
    const auto old = read_own<OldControl>(path);
    job.priority = std::clamp(old.priority, -max_priority, max_priority);
    job.held = old.held;
    job.cancel = old.cancel;
    job.crashes = old.crashes;
    job.renderer_pid = old.renderer_pid;
    job.renderer_start = old.renderer_start;
    job.renderer_boot = old.renderer_boot;
    if (!old.idempotency_key.empty()) job.key = old.idempotency_key;
    job.body_hash = old.body_hash;
    job.shards = old.shards;
  });
  reading.try_to([&] { job.state = folder.read_state(); });
  reading.try_to([&] {
    if (is_gone(folder.file("accepted.json"))) return;
    const Acceptance accepted = folder.read_acceptance();
    found.number = accepted.number;
    job.state.created = accepted.created;
    job.sweep = accepted.sweep;
    job.shards = accepted.shards;
    if (!accepted.idempotency_key.empty()) job.key = accepted.idempotency_key;
    job.body_hash = accepted.body_hash;
  });
  reading.try_to([&] { take_spec(job, folder.read_job()); });
  job.progress = folder.read_progress();
  job.pictured = has_picture(folder);
  set_state(job, reading.damage());
  return found;
}

SweepEntry read_sweep(const std::filesystem::path& dir) {
  SweepEntry sweep;
  sweep.id = dir.filename().string();
  Reading reading;
  reading.try_to([&] {
    const SweepState state = read_sweep_state(dir);
    sweep.state = state.state;
    sweep.created = state.created;
    sweep.finished = state.finished;
    sweep.runs = state.runs;
    if (!state.idempotency_key.empty()) sweep.key = state.idempotency_key;
    sweep.body_hash = state.body_hash;
  });
  reading.try_to([&] {
    const SweepSpec spec = read_sweep_spec(dir);
    sweep.label = spec.label;
    sweep.spec = write_document(spec);
    if (sweep.runs == 0) sweep.runs = expand(spec).runs.size();
  });
  if (!reading.damage().empty()) {
    sweep.state = SweepStage::failed;
    sweep.error = fmt::format("the sweep's folder cannot be read: {}", reading.damage());
  }
  return sweep;
}

std::string sweep_of(const std::vector<SweepEntry>& sweeps, const std::string& job) {
  for (const SweepEntry& sweep : sweeps) {
    const auto index = run_index(sweep.id, job);
    if (index && *index < sweep.runs) return sweep.id;
  }
  return {};
}

}  // namespace

Imported import_folders(Store& store, const DataRoot& data) {
  if (store.has_imported()) return {};
  std::vector<SweepEntry> sweeps;
  for (const std::string& id : list_job_names(data.sweeps())) {
    sweeps.push_back(read_sweep(data.sweeps() / id));
  }
  std::vector<Found> jobs;
  for (const JobFolder& folder : list_jobs(data.jobs())) {
    jobs.push_back(read_job(folder));
    JobEntry& job = jobs.back().job;
    if (job.sweep.empty()) job.sweep = sweep_of(sweeps, job.id);
  }
  std::sort(jobs.begin(), jobs.end(),
            [](const Found& a, const Found& b) { return a.order() < b.order(); });
  store.change([&](StoreChange& c) {
    for (SweepEntry& sweep : sweeps) {
      if (sweep.key && c.sweep_of_key(*sweep.key)) sweep.key.reset();
      c.add(sweep);
    }
    for (Found& found : jobs) {
      if (found.job.key && c.job_of_key(*found.job.key)) found.job.key.reset();
      c.add(found.job);
    }
    c.note_import();
  });
  return {jobs.size(), sweeps.size()};
}

}  // namespace lacuna
