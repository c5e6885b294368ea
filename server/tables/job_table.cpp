#include "server/tables/job_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "jobs/spec/job_json.h"

namespace lacuna {
namespace {

bool is_any_of(const std::vector<State>& states, State state) {
  return states.empty() || std::find(states.begin(), states.end(), state) != states.end();
}

/// A job's place in the list, as text: the same after a restart.
std::string cursor(const JobEntry& entry) { return entry.state.created + "_" + entry.id; }

std::pair<std::string_view, std::string_view> place_of(std::string_view cursor) {
  const auto bar = cursor.find('_');
  if (bar == std::string_view::npos) {
    throw std::invalid_argument("it is not the `next` of another page");
  }
  return {cursor.substr(0, bar), cursor.substr(bar + 1)};
}

}  // namespace

EntryPtr JobTable::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto found = by_id_.find(id);
  return found == by_id_.end() ? nullptr : found->second;
}

EntryPtr JobTable::add(const std::string& id, std::int64_t settled_before) {
  const auto entry = [&] {
    try {
      return read_entry(folder(id), settled_before);
    } catch (const std::exception& error) {
      return unread_entry(id, error);
    }
  }();
  entry->sweep = sweeps_.sweep_of(id);
  complete(*entry);
  const std::lock_guard lock(mutex_);
  if (const auto known = by_id_.find(id); known != by_id_.end()) return known->second;
  put(entry, JobEvent::Kind::added);
  return entry;
}

EntryPtr JobTable::reread(const std::string& id) {
  const auto entry = read_entry(folder(id));
  entry->sweep = sweeps_.sweep_of(id);
  complete(*entry);
  const std::lock_guard lock(mutex_);
  if (!by_id_.contains(id)) return nullptr;
  put(entry, JobEvent::Kind::state);
  return entry;
}

void JobTable::remove(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (!take_out(id)) return;
  ++not_indexed_;
  journal_.add(JobEvent::Kind::removed, id, nullptr);
}

/// Both only under the lock: all that is counted of a job.
void JobTable::put_in(EntryPtr entry) {
  ++counts_[entry->state.state];
  RunCounts& run_counts = run_counts_[entry->sweep];
  ++run_counts.counts[entry->state.state];
  if (!entry->over) run_counts.unfinished.insert(entry->id);
  if (!entry->control.shards.empty()) {
    merged_[entry->control.shards] = entry->id;
    if (!entry->over) unmerged_.insert(entry->id);
  }
  if (!entry->over && !entry->reference.empty()) measured_.emplace(entry->reference, entry->id);
  if (entry->unread) unread_.insert(entry->id);
  by_id_[entry->id] = entry;
  jobs_.insert(std::move(entry));
}

EntryPtr JobTable::take_out(const std::string& id) {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return nullptr;
  EntryPtr entry = found->second;
  --counts_[entry->state.state];
  RunCounts& run_counts = run_counts_[entry->sweep];
  --run_counts.counts[entry->state.state];
  run_counts.unfinished.erase(id);
  if (run_counts.jobs() == 0) run_counts_.erase(entry->sweep);
  if (!entry->control.shards.empty()) merged_.erase(entry->control.shards);
  unmerged_.erase(id);
  measured_.erase({entry->reference, id});
  unread_.erase(id);
  jobs_.erase(entry);
  by_id_.erase(found);
  return entry;
}

std::size_t JobTable::RunCounts::jobs() const {
  std::size_t sum = 0;
  for (const auto& [state, n] : counts) sum += n;
  return sum;
}

JobTable::RunCounts JobTable::run_counts(const std::string& sweep) const {
  const std::lock_guard lock(mutex_);
  const auto found = run_counts_.find(sweep);
  return found == run_counts_.end() ? RunCounts{} : found->second;
}

EntryPtr JobTable::merged_from(const std::string& sweep) const {
  const std::lock_guard lock(mutex_);
  const auto merged = merged_.find(sweep);
  return merged == merged_.end() ? nullptr : by_id_.at(merged->second);
}

std::vector<EntryPtr> JobTable::without_shards() const {
  const std::lock_guard lock(mutex_);
  std::vector<EntryPtr> jobs;
  for (const std::string& id : unmerged_) {
    const EntryPtr& entry = by_id_.at(id);
    if (!sweeps_.find(entry->control.shards)) jobs.push_back(entry);
  }
  return jobs;
}

std::optional<std::string> JobTable::measured_against(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto first = measured_.lower_bound({id, ""});
  if (first == measured_.end() || first->first != id) return std::nullopt;
  return first->second;
}

EntryPtr JobTable::unread() const {
  const std::lock_guard lock(mutex_);
  return unread_.empty() ? nullptr : by_id_.at(*unread_.begin());
}

bool JobTable::waits_for_shards(const JobEntry& entry) const {
  const std::string& sweep = entry.control.shards;
  if (sweep.empty()) return false;
  if (!sweeps_.find(sweep) || sweeps_.is_unfinished(sweep)) return true;
  const std::lock_guard lock(mutex_);
  const auto runs = run_counts_.find(sweep);
  return runs != run_counts_.end() && !runs->second.unfinished.empty();
}

/// Only under the lock. The entry is complete().
void JobTable::put(std::shared_ptr<JobEntry> entry, JobEvent::Kind kind) {
  const std::string id = entry->id;
  take_out(id);
  EntryPtr finished = std::move(entry);
  put_in(finished);
  journal_.add(kind, id, std::move(finished));
}

template <class Change>
void JobTable::change(const std::string& id, Change&& change) {
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(id);
  if (known == by_id_.end()) return;
  auto entry = std::make_shared<JobEntry>(*known->second);
  const auto kind = change(*entry);
  if (!kind) return;
  entry->stamp = 0;  // what is known here is not what was read then
  if (entry->over) ++not_indexed_;
  complete(*entry);
  put(std::move(entry), *kind);
}

void JobTable::set_state(const std::string& id, const JobState& state, bool over) {
  change(id, [&](JobEntry& entry) -> std::optional<JobEvent::Kind> {
    if (entry.state == state && entry.over == over) return std::nullopt;
    entry.state = state;
    entry.over = over;
    if (over) entry.obstacle.clear();
    return JobEvent::Kind::state;
  });
}

void JobTable::set_control(const std::string& id, const JobControl& control) {
  change(id, [&](JobEntry& entry) -> std::optional<JobEvent::Kind> {
    if (entry.control == control) return std::nullopt;
    entry.control = control;
    return JobEvent::Kind::control;
  });
}

void JobTable::set_obstacle(const std::string& id, const std::string& obstacle) {
  change(id, [&](JobEntry& entry) -> std::optional<JobEvent::Kind> {
    if (entry.obstacle == obstacle) return std::nullopt;
    entry.obstacle = obstacle;
    return JobEvent::Kind::state;
  });
}

void JobTable::set_place(const std::string& id, const std::string& place) {
  change(id, [&](JobEntry& entry) -> std::optional<JobEvent::Kind> {
    if (entry.place == place) return std::nullopt;
    entry.place = place;
    return JobEvent::Kind::state;
  });
}

void JobTable::set_progress(const std::string& id, const Progress& progress) {
  const bool pictured = has_picture(folder(id));
  change(id, [&](JobEntry& entry) -> std::optional<JobEvent::Kind> {
    if (entry.progress == progress && entry.pictured == pictured) return std::nullopt;
    entry.progress = progress;
    entry.pictured = pictured;
    return JobEvent::Kind::progress;
  });
}

void JobTable::find_sweep(const std::string& id) {
  const std::string sweep = sweeps_.sweep_of(id);
  change(id, [&](JobEntry& entry) -> std::optional<JobEvent::Kind> {
    if (entry.sweep == sweep) return std::nullopt;
    entry.sweep = sweep;
    return JobEvent::Kind::state;
  });
}

void JobTable::set_job(const std::string& id, const JobSpec& spec) {
  change(id, [&](JobEntry& entry) -> std::optional<JobEvent::Kind> {
    take_spec(entry, spec, write_job(spec));
    return JobEvent::Kind::control;
  });
}

/// How many match but for the words. Only under the lock.
std::size_t JobTable::count(const Query& query) const {
  const auto run_counts = run_counts_.find(query.sweep.value_or(""));
  if (query.sweep && run_counts == run_counts_.end()) return 0;
  std::size_t sum = 0;
  for (const auto& [state, n] : query.sweep ? run_counts->second.counts : counts_) {
    if (is_any_of(query.states, state)) sum += n;
  }
  return sum;
}

JobTable::Page JobTable::list(const Query& query) const {
  const std::string words = lower_case(query.words);
  const Place after = query.after.empty() ? Place{} : place_of(query.after);
  Page page;
  const std::lock_guard lock(mutex_);
  page.counts = counts_;
  page.last_event = journal_.name(journal_.last());
  // Only a search by words has to look at every job; other pages cost what they hold.
  const bool counts_known = words.empty();
  if (counts_known) page.total = count(query);
  const bool begins_after = counts_known && !query.after.empty();
  auto it = begins_after ? std::make_reverse_iterator(jobs_.lower_bound(after)) : jobs_.rbegin();
  for (; it != jobs_.rend(); ++it) {
    const EntryPtr& entry = *it;
    if (!is_any_of(query.states, entry->state.state)) continue;
    if (query.sweep && *query.sweep != entry->sweep) continue;
    if (entry->words.find(words) == std::string::npos) continue;
    if (!counts_known) ++page.total;
    if (!query.after.empty() && ByPlace::place(entry) >= after) continue;
    if (page.jobs.size() < query.limit) {
      page.jobs.push_back(entry);
    } else {
      if (page.next.empty()) page.next = cursor(*page.jobs.back());
      if (counts_known) break;
    }
  }
  return page;
}

JobTable::Counts JobTable::counts() const {
  Counts counts;
  for (const auto& value : EnumTable<State>::values) counts[value.value] = 0;
  const std::lock_guard lock(mutex_);
  for (const auto& [state, n] : counts_) counts[state] = n;
  return counts;
}

std::vector<EntryPtr> JobTable::all() const {
  const std::lock_guard lock(mutex_);
  return {jobs_.begin(), jobs_.end()};
}

}  // namespace lacuna
