#include "server/tables/sweep_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/storage/file_handle.h"
#include "analysis/storage/passing_error.h"
#include "jobs/store/new_folder.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

SweepEntryPtr read_sweep(const std::filesystem::path& dir) {
  auto entry = std::make_shared<SweepEntry>();
  entry->id = dir.filename().string();
  try {
    entry->state = read_sweep_state(dir);
    entry->label = read_sweep_spec(dir).label;
  } catch (const std::exception& error) {  // a damaged folder hides no other sweep
    entry->unread = may_pass(error);
    if (entry->unread) entry->state = {};
    if (!entry->unread) entry->state.state = SweepStage::failed;
    entry->error = fmt::format("the sweep's folder cannot be read{}: {}",
                               entry->unread ? " for now" : "", error.what());
  }
  return entry;
}

}  // namespace

void SweepTable::read() {
  std::filesystem::create_directories(data_.sweeps());
  remove_stale_folders(data_.sweeps());
  const std::lock_guard lock(mutex_);
  for (const std::string& id : list_job_names(data_.sweeps())) {
    const SweepEntryPtr entry = sweeps_[id] = read_sweep(dir(id));
    if (!entry->error.empty()) log::error("{} is left alone: {}", id, entry->error);
  }
}

SweepEntryPtr SweepTable::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = sweeps_.find(id);
  return found == sweeps_.end() ? nullptr : found->second;
}

bool SweepTable::reread(const std::string& id) {
  SweepEntryPtr entry = read_sweep(dir(id));
  if (entry->unread) return false;
  log::info("{}: its folder can be read again", id);
  const std::lock_guard lock(mutex_);
  sweeps_[id] = std::move(entry);
  return true;
}

std::vector<SweepEntryPtr> SweepTable::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<SweepEntryPtr> all;
  all.reserve(sweeps_.size());
  for (const auto& [id, entry] : sweeps_) all.push_back(entry);
  return all;
}

std::string SweepTable::sweep_of(const std::string& job_id) const {
  constexpr std::size_t to_the_second = std::string_view("20260131-235959-").size();
  const std::lock_guard lock(mutex_);
  // Only sweeps of the same second have runs with such ids.
  for (auto it = sweeps_.lower_bound(job_id.substr(0, to_the_second)); it != sweeps_.end(); ++it) {
    const auto index = run_index(it->first, job_id);
    if (!index) break;
    const std::size_t runs = it->second->unread ? max_sweep_runs : it->second->state.runs;
    if (*index < runs) return it->first;
  }
  return {};
}

std::set<std::string> SweepTable::unfinished() const {
  std::set<std::string> ids;
  for (const SweepEntryPtr& entry : all()) {
    if (!is_over(entry->state.state)) ids.insert(entry->id);
  }
  return ids;
}

bool SweepTable::is_unfinished(const std::string& id) const {
  const SweepEntryPtr entry = find(id);
  return entry && !is_over(entry->state.state);
}

std::shared_ptr<const SweepFolder> SweepTable::open(const std::string& id) {
  {
    const std::lock_guard lock(mutex_);
    for (const FolderPtr& folder : opened_) {
      if (folder->id() == id) return folder;
    }
  }
  auto folder = std::make_shared<const SweepFolder>(dir(id));
  keep(folder);
  return folder;
}

/// So that a page that looks at a sweep again and again does not have its plan made each time.
void SweepTable::keep(const FolderPtr& folder) {
  constexpr std::size_t most = 4;
  const std::lock_guard lock(mutex_);
  opened_.push_front(folder);
  if (opened_.size() > most) opened_.pop_back();
}

/// Whether a sweep with this id and so many runs would share an id with another or its runs, be
/// they made or not.
bool SweepTable::is_taken(const std::string& id, std::size_t runs) const {
  if (!sweep_of(id).empty()) return true;
  const auto sweeps = all();
  return std::any_of(sweeps.begin(), sweeps.end(), [&](const SweepEntryPtr& other) {
    const auto index = run_index(id, other->id);
    return index && (other->id == id || *index < runs);
  });
}

SweepEntryPtr SweepTable::create(const SweepSpec& spec, SweepPlan plan, SweepState state,
                                 const std::function<void(const std::string& id)>& before) {
  const std::lock_guard one_at_a_time(creating_);
  const std::size_t runs = plan.runs.size();
  const std::string id = new_sweep_id(
      data_, runs, [&](const std::string& candidate) { return is_taken(candidate, runs); });
  before(id);
  return make(id, spec, std::move(plan), std::move(state));
}

SweepEntryPtr SweepTable::create_again(const std::string& id, const SweepSpec& spec,
                                       SweepPlan plan) {
  const std::lock_guard one_at_a_time(creating_);
  if (SweepEntryPtr there = find(id)) return there;
  return make(id, spec, std::move(plan), {});
}

/// Only while creating_ is held.
SweepEntryPtr SweepTable::make(const std::string& id, const SweepSpec& spec, SweepPlan plan,
                               SweepState state) {
  state.created = utc_now();
  state.runs = plan.runs.size();
  keep(std::make_shared<const SweepFolder>(
      SweepFolder::create_served(data_, id, spec, std::move(plan), state)));
  auto entry = std::make_shared<SweepEntry>();
  entry->id = id;
  entry->label = spec.label;
  entry->state = std::move(state);
  const std::lock_guard lock(mutex_);
  return sweeps_[id] = std::move(entry);
}

void SweepTable::set_stage(const std::string& id, SweepStage stage) {
  const std::lock_guard lock(mutex_);
  const auto found = sweeps_.find(id);
  if (found == sweeps_.end() || found->second->state.state == stage) return;
  auto entry = std::make_shared<SweepEntry>(*found->second);
  entry->state.state = stage;
  entry->state.finished = is_over(stage) ? utc_now() : "";
  write_sweep_state(dir(id), entry->state);
  found->second = std::move(entry);
}

void SweepTable::give_up(const std::string& id, const std::string& error) {
  const std::lock_guard lock(mutex_);
  const auto found = sweeps_.find(id);
  if (found == sweeps_.end()) return;
  log::error("{} is given up: {}", id, error);
  auto entry = std::make_shared<SweepEntry>(*found->second);
  entry->state.state = SweepStage::failed;
  entry->error = error;
  found->second = std::move(entry);
}

void SweepTable::remove(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = sweeps_.find(id);
  if (found == sweeps_.end()) return;
  remove_folder_whole(dir(id));
  sweeps_.erase(found);
  opened_.remove_if([&](const FolderPtr& folder) { return folder->id() == id; });
}

}  // namespace lacuna
