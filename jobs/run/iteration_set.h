#pragma once

#include <cstdint>
#include <vector>

#include "jobs/spec/job_spec.h"

namespace lacuna {

class ByteWriter;
class ByteReader;

/// Iterations of a job have numbers below this.
inline constexpr std::uint64_t max_iterations = (std::uint64_t{1} << 32) - 1;

/// Which iterations of a job are done, and which comes next.
///
/// Shards are dealt the iterations in turn, in pairs of an even and an odd one: shard k of n
/// renders 2 (j n + k) and 2 (j n + k) + 1 for j = 0, 1, ... Unlike ranges, this needs no number of
/// iterations to be known, so it serves budgets of time and larger budgets later as well; each
/// shard has both halves of the picture, so it can estimate its own error; and methods whose
/// iterations change with their number, as radii that shrink, advance evenly. Random numbers are
/// counted by (seed, iteration, ...), so shards use disjoint streams.
class IterationSet {
 public:
  /// None of a whole job yet.
  IterationSet() : IterationSet(1, 0) {}
  /// None of shard `k` of `shards` yet; counted from 0.
  IterationSet(std::uint32_t shards, std::uint32_t k) : shards_(shards), first_(k), counts_{0} {}

  /// The lowest iteration that is not done: what is rendered next.
  std::uint64_t next() const;
  /// Marks next() as done.
  void add_next();
  /// How many are done, and how many of them are even.
  std::uint64_t count() const;
  std::uint64_t count_even() const;
  /// How many of this set's iterations, done or not, have a number below `end`.
  std::uint64_t count_below(std::uint64_t end) const;

  /// Whether this is of the whole job, without a gap.
  bool is_whole() const { return shards_ == 1; }
  /// Whether a job can go on with this: of the same shard; a whole job also from all of its shards.
  bool serves(const IterationSet& other) const;
  /// Adds those of another shard of as many. Throws std::invalid_argument on another number of
  /// shards, and on one that is in already.
  void merge(const IterationSet& shard);
  /// After the last merge(): makes this a set of the whole job if there is no gap. What add_next()
  /// fills last is the last gap, too.
  void simplify();

  /// For checkpoints. load() throws std::runtime_error on what save() never writes.
  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  std::uint32_t shards_ = 1;
  std::uint32_t first_ = 0;            ///< the shard of counts_[0]
  std::vector<std::uint64_t> counts_;  ///< done by shard: of one, or of all in order
};

}  // namespace lacuna
