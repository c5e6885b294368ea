#pragma once

#include <cstdint>
#include <vector>

#include "jobs/spec/job_spec.h"

namespace lacuna {

class ByteWriter;
class ByteReader;

/// Upper bound (exclusive) of iteration numbers.
inline constexpr std::uint64_t max_iterations = (std::uint64_t{1} << 32) - 1;

/// The completed iterations of a job or shard, and the next one.
///
/// Iterations are distributed to shards in turn, in pairs of an even and an odd one: shard k of n
/// renders 2 (j n + k) and 2 (j n + k) + 1 for j = 0, 1, ... Unlike ranges, this does not need the
/// number of iterations, so it works with time budgets and with later, larger budgets; each shard
/// has both halves of the picture, so it can estimate its own error; and methods whose iterations
/// depend on their number, as shrinking radii, advance evenly. Random numbers are indexed by (seed,
/// iteration, ...), so shards use disjoint streams.
class IterationSet {
 public:
  /// An empty set of a whole job.
  IterationSet() : IterationSet(1, 0) {}
  /// An empty set of shard `k` of `shards`, from 0.
  IterationSet(std::uint32_t shards, std::uint32_t k) : shards_(shards), first_(k), counts_{0} {}

  /// The lowest iteration that is not done, which is rendered next.
  std::uint64_t next() const;
  /// Marks next() as done.
  void add_next();
  /// Number of completed iterations, and of even ones.
  std::uint64_t count() const;
  std::uint64_t count_even() const;
  /// Number of iterations below `end` that belong to this set, done or not.
  std::uint64_t count_below(std::uint64_t end) const;

  /// Whether this set is of the whole job, without a gap.
  bool is_whole() const { return shards_ == 1; }
  /// Whether a job with the set `other` can continue from this one: of the same shard, or for a
  /// whole job of all its shards.
  bool serves(const IterationSet& other) const;
  /// Adds the set of another shard. Throws std::invalid_argument for a different number of shards,
  /// and for a shard that was added already.
  void merge(const IterationSet& shard);
  /// After the last merge(): converts this to a set of the whole job if there is no gap. add_next()
  /// does so when it fills the last gap.
  void simplify();

  /// For checkpoints. load() throws std::runtime_error on what save() never writes.
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  std::uint32_t shards_ = 1;
  std::uint32_t first_ = 0;            ///< the shard of counts_[0]
  std::vector<std::uint64_t> counts_;  ///< completed iterations by shard: one, or all in order
};

}  // namespace lacuna
