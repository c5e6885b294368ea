// How the table comes from the folders and the index, and the index from the table.

#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <future>

#include "analysis/storage/passing_error.h"
#include "server/tables/job_index.h"
#include "server/tables/job_table.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

std::int64_t time_of_change(const std::filesystem::path& folder) {
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0) return 0;
  return status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec;
}

/// Calls `work` on this thread and some others: on a file system of many machines each file costs
/// an answer of another machine, and the processor does nothing meanwhile.
void on_readers(std::size_t jobs, const std::function<void()>& work) {
  constexpr std::size_t most_readers = 8, for_a_reader = 64;
  std::vector<std::future<void>> readers;
  while (readers.size() < std::min(most_readers, jobs / for_a_reader)) {
    readers.push_back(std::async(std::launch::async, work));
  }
  work();
  for (std::future<void>& reader : readers) reader.get();
}

}  // namespace

/// Folders that changed earlier are settled; 0: the time cannot be told, and there are no stamps.
std::int64_t JobTable::settled_before() const {
  try {
    return file_system_time(data_.dir) - index_.settled.count();
  } catch (const std::exception& error) {
    log::warn("the index of jobs is not used: {}", error.what());
    return 0;
  }
}

void JobTable::rescan() {
  // Taken before the folder is read: what changes meanwhile is seen next time.
  const std::int64_t changed = time_of_change(data_.jobs());
  const std::vector<std::string> there = list_job_names(data_.jobs());
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    first = scanned_ == -1;
    scanned_ = changed;
  }
  const std::int64_t settled = first && there.size() >= index_.least_jobs ? settled_before() : 0;
  if (settled != 0) add_indexed(there, settled);
  const auto [fresh, gone] = compare(there);
  add_all(fresh, settled);
  for (const std::string& id : gone) {
    // It may have been added while the folder was read.
    if (is_gone(folder(id).dir())) remove(id);
  }
}

/// The ids of `there`, sorted, that the table does not have, and those that only the table has. The
/// lock is held for a part at a time: requests do not wait for a walk through all jobs.
std::pair<std::vector<std::string>, std::vector<std::string>> JobTable::compare(
    const std::vector<std::string>& there) const {
  constexpr std::size_t at_once = 2048;
  std::vector<std::string> fresh, gone;
  for (std::size_t begin = 0, end = 0; begin == 0 || begin < there.size(); begin = end) {
    end = std::min(there.size(), begin + at_once);
    const std::lock_guard lock(mutex_);
    auto known = begin == 0 ? by_id_.begin() : by_id_.upper_bound(there[begin - 1]);
    for (std::size_t i = begin; i < end; ++i) {
      for (; known != by_id_.end() && known->first < there[i]; ++known)
        gone.emplace_back(known->first);
      if (known != by_id_.end() && known->first == there[i]) {
        ++known;
      } else {
        fresh.push_back(there[i]);
      }
    }
    if (end < there.size()) continue;
    for (; known != by_id_.end(); ++known) gone.emplace_back(known->first);
    break;
  }
  return {std::move(fresh), std::move(gone)};
}

/// Adds what the index knows of the folders `there`, sorted, and that has not changed since.
void JobTable::add_indexed(const std::vector<std::string>& there, std::int64_t settled_before) {
  JobIndexReader index(index_file());
  on_readers(there.size(), [&] {
    for (auto entries = index.next(); !entries.empty(); entries = index.next()) {
      for (const std::shared_ptr<JobEntry>& entry : entries) {
        if (!std::binary_search(there.begin(), there.end(), entry->id)) continue;
        if (folder_stamp(folder(entry->id), settled_before) != entry->stamp) continue;
        const std::string sweep = sweeps_.sweep_of(entry->id);
        if (sweep != entry->sweep) {
          entry->sweep = sweep;
          complete(*entry);
        }
        const std::lock_guard lock(mutex_);
        if (!by_id_.contains(entry->id)) put(entry, JobEvent::Kind::added);
      }
    }
  });
  const std::lock_guard lock(mutex_);
  not_indexed_ = there.size() - by_id_.size();
}

void JobTable::add_all(const std::vector<std::string>& ids, std::int64_t settled_before) {
  std::atomic<std::size_t> next = 0;
  on_readers(ids.size(), [&] {
    for (std::size_t i = next++; i < ids.size(); i = next++) {
      if (is_job(folder(ids[i]))) add(ids[i], settled_before);
    }
  });
}

/// The entry with a stamp, so that it can go into the index: read anew, as it may have been changed
/// on disk by somebody else. Nothing if the folder is not settled yet, or says something else.
EntryPtr JobTable::stamped(const EntryPtr& entry, std::int64_t settled_before) {
  std::shared_ptr<JobEntry> read;
  try {
    read = read_entry(folder(entry->id), settled_before);
  } catch (const std::exception&) {  // it will be read another time
    return nullptr;
  }
  if (read->stamp == 0 || !read->over || read->damaged) return nullptr;
  read->sweep = entry->sweep;
  complete(*read);
  if (read->text != entry->text || read->revision_hash != entry->revision_hash) return nullptr;
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(entry->id);
  if (known == by_id_.end() || known->second != entry) return nullptr;
  const EntryPtr result = read;
  take_out(entry->id);
  put_in(result);
  return result;
}

void JobTable::save_index() {
  {
    const std::lock_guard lock(mutex_);
    const std::size_t jobs = by_id_.size();
    constexpr std::size_t index_share = 100;
    if (jobs < index_.least_jobs) return;
    if (not_indexed_ < std::max(index_.least_missing, jobs / index_share)) return;
  }
  const std::int64_t settled = settled_before();
  if (settled == 0) return;
  std::vector<EntryPtr> indexed;
  for (EntryPtr& entry : all()) {
    if (!entry->over || entry->damaged) continue;
    if (entry->stamp == 0) entry = stamped(entry, settled);
    if (entry) indexed.push_back(std::move(entry));
  }
  write_job_index(index_file(), indexed);
  const std::lock_guard lock(mutex_);
  not_indexed_ = 0;
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

}  // namespace lacuna
