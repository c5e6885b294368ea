#include "jobs/run/iteration_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "base/storage/bytes.h"

namespace lacuna {

namespace {

/// The number of the iteration that shard `k` of `n` renders after `done` others.
std::uint64_t iteration(std::uint64_t n, std::uint64_t k, std::uint64_t done) {
  return 2 * (done / 2 * n + k) + done % 2;
}

/// Number of iterations of shard `k` of `n` below `end`.
std::uint64_t dealt(std::uint64_t n, std::uint64_t k, std::uint64_t end) {
  const std::uint64_t pairs = end / 2;
  const std::uint64_t whole = k < pairs ? (pairs - 1 - k) / n + 1 : 0;
  return 2 * whole + (end % 2 == 1 && pairs % n == k ? 1 : 0);
}

}  // namespace

std::uint64_t IterationSet::next() const {
  std::uint64_t lowest = iteration(shards_, first_, counts_[0]);
  for (std::size_t k = 1; k < counts_.size(); ++k) {
    lowest = std::min(lowest, iteration(shards_, first_ + k, counts_[k]));
  }
  return lowest;
}

void IterationSet::add_next() {
  const std::uint64_t k = next() / 2 % shards_;
  ++counts_[k - first_];
  simplify();
}

std::uint64_t IterationSet::count() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
}

std::uint64_t IterationSet::count_even() const {
  std::uint64_t even = 0;
  for (const std::uint64_t count : counts_) even += count - count / 2;
  return even;
}

std::uint64_t IterationSet::count_below(std::uint64_t end) const {
  std::uint64_t count = 0;
  for (std::size_t k = 0; k < counts_.size(); ++k) count += dealt(shards_, first_ + k, end);
  return count;
}

bool IterationSet::serves(const IterationSet& other) const {
  const bool same = shards_ == other.shards_ && first_ == other.first_;
  return (same && counts_.size() == other.counts_.size()) ||
         (other.is_whole() && counts_.size() == shards_);
}

void IterationSet::merge(const IterationSet& shard) {
  if (shard.shards_ != shards_) {
    throw std::invalid_argument(
        fmt::format("shards of {} and of {} cannot be merged", shards_, shard.shards_));
  }
  if (counts_.size() < shards_) {
    std::vector<std::uint64_t> all(shards_, 0);
    all[first_] = counts_[0];
    counts_ = std::move(all);
    first_ = 0;
  }
  for (std::size_t k = 0; k < shard.counts_.size(); ++k) {
    std::uint64_t& count = counts_[shard.first_ + k];
    if (count > 0 && shard.counts_[k] > 0) {
      throw std::invalid_argument(
          fmt::format("shard {} of {} was added already", shard.first_ + k + 1, shards_));
    }
    count += shard.counts_[k];
  }
}

void IterationSet::simplify() {
  if (counts_.size() < shards_ || shards_ == 1) return;
  const std::uint64_t n = count();
  if (next() != n) return;  // there is a gap before the last iteration
  shards_ = 1;
  counts_ = {n};
}

void IterationSet::save(ByteWriter& out) const {
  out.put(shards_);
  out.put(first_);
  out.put(counts_);
}

void IterationSet::load(ByteReader& in) {
  shards_ = in.get<std::uint32_t>();
  first_ = in.get<std::uint32_t>();
  counts_ = in.get_vector<std::uint64_t>();
  const bool one = counts_.size() == 1 && first_ < shards_;
  const bool all = counts_.size() == shards_ && first_ == 0;
  const bool small = std::all_of(counts_.begin(), counts_.end(),
                                 [](std::uint64_t n) { return n <= max_iterations; });
  if (shards_ == 0 || shards_ > std::uint32_t{max_shards} || !(one || all) || !small) {
    throw std::runtime_error("saved iterations do not belong to a job");
  }
}

}  // namespace lacuna
