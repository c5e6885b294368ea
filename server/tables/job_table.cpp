#include "server/tables/job_table.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <variant>

#include "analysis/storage/passing_error.h"
#include "jobs/spec/job_json.h"
#include "server/tables/entry_json.h"

namespace lacuna {
namespace {

std::string hash(std::string_view text) {
  return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// `text`: of job.json.
void take_spec(JobEntry& entry, const JobSpec& spec, const std::string& text) {
  entry.label = spec.label;
  entry.scene = spec.scene;
  entry.integrator = std::visit([](const auto& s) { return std::string(s.name); }, spec.integrator);
  entry.reference = spec.reference;
  entry.exclusive = spec.exclusive;
  entry.job_hash = hash(text);
}

bool has_picture(const JobFolder& folder) {
  std::error_code unknown;
  return std::filesystem::exists(folder.file("image.png"), unknown);
}

/// The first thing that a folder could not tell.
class Damage {
 public:
  /// Throws on what may pass.
  template <class Read>
  void try_to(Read&& read) {
    try {
      read();
    } catch (const std::exception& error) {
      if (may_pass(error)) throw;
      if (reason_.empty()) reason_ = error.what();
    }
  }
  const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
};

/// Throws what may pass. A damaged folder tells what it can: its key still counts.
std::shared_ptr<JobEntry> read_entry(const JobFolder& folder) {
  auto entry = std::make_shared<JobEntry>();
  entry->id = folder.id();
  Damage damage;
  damage.try_to([&] { entry->control = folder.read_control(); });
  damage.try_to([&] { entry->state = folder.read_state(); });
  damage.try_to([&] {
    const std::string text = folder.read_job_text();
    take_spec(*entry, parse_job(text), text);
  });
  entry->progress = folder.read_progress();
  entry->pictured = has_picture(folder);
  entry->over = is_terminal(entry->state.state);
  if (damage.reason().empty()) return entry;
  entry->damaged = entry->over = true;
  entry->state.state = State::failed;
  entry->state.error = fmt::format("the job's folder cannot be read: {}", damage.reason());
  return entry;
}

std::shared_ptr<JobEntry> unread_entry(const std::string& id, const std::exception& error) {
  auto entry = std::make_shared<JobEntry>();
  entry->id = id;
  entry->unread = true;
  entry->obstacle = fmt::format("the job's folder cannot be read for now: {}", error.what());
  return entry;
}

/// Makes what follows from the rest.
void complete(JobEntry& entry) {
  entry.text = json_text(to_json(entry));
  entry.revision =
      hash(fmt::format("{} {} {} {} {}", entry.job_hash, json_text(to_json(entry.state)),
                       entry.control.priority, entry.control.held, entry.control.cancel));
  entry.words = lower_case(
      fmt::format("{}\n{}\n{}\n{}", entry.label, entry.scene, entry.integrator, entry.id));
}

std::int64_t time_of_change(const std::filesystem::path& folder) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0) return 0;
  return status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec;
}

bool is_any_of(const std::vector<State>& states, State state) {
  return states.empty() || std::find(states.begin(), states.end(), state) != states.end();
}

/// A job's place in the list, as text: the same after a restart.
std::string cursor(const JobEntry& entry) { return entry.state.created + "_" + entry.id; }

std::pair<std::string, std::string> place_of(const std::string& cursor) {
  const auto bar = cursor.find('_');
  if (bar == std::string::npos) {
    throw std::invalid_argument("it is not the `next` of another page");
  }
  return {cursor.substr(0, bar), cursor.substr(bar + 1)};
}

}  // namespace

void JobTable::rescan() {
  // Taken before the folder is read: what changes meanwhile is seen next time.
  const std::int64_t changed = time_of_change(data_.jobs());
  const std::vector<std::string> there = list_job_names(data_.jobs());
  std::vector<std::string> fresh, gone;
  {
    const std::lock_guard lock(mutex_);
    scanned_ = changed;
    for (const std::string& id : there) {
      if (!places_.contains(id)) fresh.push_back(id);
    }
    for (const auto& [id, place] : places_) {
      if (!std::binary_search(there.begin(), there.end(), id)) gone.push_back(id);
    }
  }
  add_all(fresh);
  for (const std::string& id : gone) {
    std::error_code ignored;  // it may have been added while the folder was read
    if (!std::filesystem::exists(folder(id).dir(), ignored)) remove(id);
  }
}

/// Reads them side by side: on a file system of many machines each file costs an answer of another
/// machine, and the processor does nothing meanwhile.
void JobTable::add_all(const std::vector<std::string>& ids) {
  constexpr std::size_t most_readers = 8, for_a_reader = 64;
  std::atomic<std::size_t> next = 0;
  const auto read = [&] {
    for (std::size_t i = next++; i < ids.size(); i = next++) {
      if (is_job(folder(ids[i]))) add(ids[i]);
    }
  };
  std::vector<std::future<void>> readers;
  while (readers.size() < std::min(most_readers, ids.size() / for_a_reader)) {
    readers.push_back(std::async(std::launch::async, read));
  }
  read();
  for (std::future<void>& reader : readers) reader.get();
}

bool JobTable::rescan_if_changed() {
  const std::int64_t changed = time_of_change(data_.jobs());
  {
    const std::lock_guard lock(mutex_);
    if (changed == scanned_) return false;
  }
  rescan();
  return true;
}

EntryPtr JobTable::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto place = places_.find(id);
  return place == places_.end() ? nullptr : jobs_.at(place->second);
}

EntryPtr JobTable::add(const std::string& id) {
  const auto entry = [&] {
    try {
      return read_entry(folder(id));
    } catch (const std::exception& error) {
      return unread_entry(id, error);
    }
  }();
  entry->sweep = sweeps_.sweep_of(id);
  complete(*entry);
  const std::lock_guard lock(mutex_);
  if (const auto place = places_.find(id); place != places_.end()) return jobs_.at(place->second);
  put(entry, JobEvent::Kind::added);
  return entry;
}

EntryPtr JobTable::reread(const std::string& id) {
  const auto entry = read_entry(folder(id));
  entry->sweep = sweeps_.sweep_of(id);
  complete(*entry);
  const std::lock_guard lock(mutex_);
  if (!places_.contains(id)) return nullptr;
  put(entry, JobEvent::Kind::state);
  return entry;
}

void JobTable::remove(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (take_out(id)) journal_.add(JobEvent::Kind::removed, id, nullptr);
}

/// Both only under the lock: all that is counted of a job.
void JobTable::put_in(const Place& place, EntryPtr entry) {
  ++counts_[entry->state.state];
  RunCounts& run_counts = run_counts_[entry->sweep];
  ++run_counts.counts[entry->state.state];
  if (!entry->over) run_counts.unfinished.insert(entry->id);
  places_[entry->id] = place;
  jobs_[place] = std::move(entry);
}

EntryPtr JobTable::take_out(const std::string& id) {
  const auto place = places_.find(id);
  if (place == places_.end()) return nullptr;
  const auto job = jobs_.find(place->second);
  EntryPtr entry = job->second;
  --counts_[entry->state.state];
  RunCounts& run_counts = run_counts_[entry->sweep];
  --run_counts.counts[entry->state.state];
  run_counts.unfinished.erase(id);
  if (run_counts.jobs() == 0) run_counts_.erase(entry->sweep);
  jobs_.erase(job);
  places_.erase(place);
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

/// Only under the lock. The entry is complete().
void JobTable::put(std::shared_ptr<JobEntry> entry, JobEvent::Kind kind) {
  const std::string id = entry->id;
  const Place place{entry->state.created, id};
  take_out(id);
  EntryPtr finished = std::move(entry);
  put_in(place, finished);
  journal_.add(kind, id, std::move(finished));
}

template <class Change>
void JobTable::change(const std::string& id, Change&& change) {
  const std::lock_guard lock(mutex_);
  const auto place = places_.find(id);
  if (place == places_.end()) return;
  auto entry = std::make_shared<JobEntry>(*jobs_.at(place->second));
  const auto kind = change(*entry);
  if (!kind) return;
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
    const auto& [place, entry] = *it;
    if (!is_any_of(query.states, entry->state.state)) continue;
    if (query.sweep && *query.sweep != entry->sweep) continue;
    if (entry->words.find(words) == std::string::npos) continue;
    if (!counts_known) ++page.total;
    if (!query.after.empty() && place >= after) continue;
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
  std::vector<EntryPtr> all;
  all.reserve(jobs_.size());
  for (const auto& [place, entry] : jobs_) all.push_back(entry);
  return all;
}

}  // namespace lacuna
