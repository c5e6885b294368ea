#pragma once

#include <functional>
#include <string>
#include <vector>

#include "jobs/run/checkpoint.h"
#include "jobs/run/run_state.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// One rendered shard.
struct Shard {
  JobFolder folder;
  JobSpec spec;
  std::uint64_t iterations = 0;  ///< from its report
  std::string processor;         ///< on which it was rendered
};

struct MergeCallbacks {
  /// Called once, with the integrator's learned state of the first shard with the most iterations:
  /// the states of two shards cannot be added.
  std::function<void(ByteReader&)> load_learned;
  std::function<void()> after_each;  ///< called after each shard added to `state`
  BetweenPieces between_pieces;      ///< of a checkpoint
};

/// Adds the checkpoints of `shards`, one after the other, to `state`, which is that of the whole
/// job before its first iteration. `key`: of their checkpoints.
///
/// Sums, counts and clocks are added; the longest clock is kept, too. The curve is that of the
/// first shard, followed by the rows that `after_each` adds. Throws std::runtime_error that names a
/// shard whose checkpoint is missing, damaged or does not match its report; std::system_error.
void merge_shards(const std::vector<Shard>& shards, const std::string& key, RunState& state,
                  const MergeCallbacks& callbacks);

}  // namespace lacuna
