#pragma once

#include <functional>
#include <string>
#include <vector>

#include "jobs/run/checkpoint.h"
#include "jobs/run/run_state.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// One shard that is rendered.
struct Shard {
  JobFolder folder;
  JobSpec spec;
  std::uint64_t iterations = 0;  ///< as its report has them
  std::string processor;         ///< that rendered it
};

struct MergeCallbacks {
  /// Reads, once, what the integrator has learned in the shard of the most iterations, the first of
  /// those: the states of two cannot be added.
  std::function<void(ByteReader&)> load_learned;
  std::function<void()> after_each;  ///< when `state` has one more of them
  BetweenPieces between_pieces;      ///< of a checkpoint
};

/// Adds up the checkpoints of `shards`, one after the other, into `state`, which is that of the
/// whole job before its first iteration. `key`: of their checkpoints.
///
/// Sums and counts add up; so do the clocks, beside the longest of them. The curve is that of the
/// first shard, and goes on by what `after_each` adds. Throws std::runtime_error that names the
/// shard whose checkpoint is missing, damaged or not that of its report; std::system_error.
void merge_shards(const std::vector<Shard>& shards, const std::string& key, RunState& state,
                  const MergeCallbacks& callbacks);

}  // namespace lacuna
