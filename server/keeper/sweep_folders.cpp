#include "server/keeper/sweep_folders.h"

#include "base/log/log.h"
#include "base/storage/passing_error.h"
#include "jobs/spec/described_json.h"
#include "jobs/store/new_folder.h"

namespace lacuna {

SweepFolders::FolderPtr SweepFolders::open(const SweepEntry& sweep) {
  {
    const std::lock_guard lock(mutex_);
    for (const FolderPtr& folder : opened_) {
      if (folder->id() == sweep.id) return folder;
    }
  }
  const SweepSpec spec = parse_sweep(sweep.spec);
  return keep(sweep, spec, expand(spec));
}

SweepFolders::FolderPtr SweepFolders::keep(const SweepEntry& sweep, const SweepSpec& spec,
                                           SweepPlan plan) {
  constexpr std::size_t most = 4;
  auto folder = std::make_shared<const SweepFolder>(
      SweepFolder::of_service(data_, sweep.id, spec, std::move(plan)));
  note(sweep);
  const std::lock_guard lock(mutex_);
  opened_.push_front(folder);
  if (opened_.size() > most) opened_.pop_back();
  return folder;
}

void SweepFolders::note(const SweepEntry& sweep) const {
  try {
    write_sweep_state(dir(sweep.id), {.state = sweep.state,
                                      .created = sweep.created,
                                      .finished = sweep.finished,
                                      .runs = sweep.runs,
                                      .idempotency_key = sweep.key.value_or(""),
                                      .body_hash = sweep.body_hash});
  } catch (const std::exception& error) {  // the store has it
    log::warn("{}: {}", sweep.id, error.what());
  }
}

void SweepFolders::remove(const std::string& id) {
  if (!is_gone(dir(id))) remove_folder_whole(dir(id));
  const std::lock_guard lock(mutex_);
  opened_.remove_if([&](const FolderPtr& folder) { return folder->id() == id; });
}

}  // namespace lacuna
