#include "jobs/queue/rows.h"
#include "jobs/queue/store.h"

namespace lacuna {

std::optional<JobEntry> StoreChange::find_job(const std::string& id) const {
  return rows::job(store_.database_, id);
}

std::vector<JobEntry> StoreChange::begun_jobs() const {
  return rows::select<JobEntry>(store_.database_, "WHERE begun");
}

void StoreChange::add(JobEntry& entry) {
  entry.number = entry.revision = ++number_;
  rows::add(store_.database_, entry);
  effects_.push_back({number_, std::nullopt, entry});
}

void StoreChange::put(JobEntry entry) {
  auto before = find_job(entry.id);
  if (!before) return;
  entry.place.clear();
  entry.number = before->number;
  entry.revision = before->revision;
  if (entry == *before) return;
  entry.revision = ++number_;
  rows::put(store_.database_, entry);
  effects_.push_back({number_, std::move(before), std::move(entry)});
}

void StoreChange::remove_job(const std::string& id) {
  auto before = find_job(id);
  if (!before) return;
  Statement(store_.database_, "DELETE FROM jobs WHERE id=?").bind(id).run();
  Statement(store_.database_, "INSERT INTO removed VALUES (?, ?)").bind(++number_).bind(id).run();
  effects_.push_back({number_, std::move(before), std::nullopt});
}

std::optional<SweepEntry> StoreChange::find_sweep(const std::string& id) const {
  return rows::first<SweepEntry>(store_.database_, "WHERE id=?", id);
}

void StoreChange::add(SweepEntry& entry) {
  entry.number = ++number_;
  rows::add(store_.database_, entry);
}

void StoreChange::put(SweepEntry entry) { rows::put(store_.database_, entry); }

void StoreChange::remove_sweep(const std::string& id) {
  Statement(store_.database_, "DELETE FROM sweeps WHERE id=?").bind(id).run();
}

void StoreChange::note_import() {
  store_.database_.run("INSERT INTO facts VALUES ('imported', 1)");
}

std::optional<JobEntry> StoreChange::job_of_key(const std::string& key) const {
  return rows::first<JobEntry>(store_.database_, "WHERE key=?", key);
}

std::optional<SweepEntry> StoreChange::sweep_of_key(const std::string& key) const {
  return rows::first<SweepEntry>(store_.database_, "WHERE key=?", key);
}

}  // namespace lacuna
