#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "base/storage/bytes.h"
#include "renderer/core/rng.h"

namespace lacuna {

/// A pass of an iteration, after which a guide learns. The first iteration is divided: its first
/// pass renders 1/64 of the blocks of 8 x 8 pixels, each later pass as many as all passes before
/// it, so that earlier passes guide most of its paths. Later iterations are one pass.
struct LearningPass {
  static constexpr int parts = 64;

  int first = 0, end = parts;  ///< of the parts that the pass renders

  double share() const { return double(end - first) / parts; }
  /// Whether the pass renders the block whose first pixel is `x`, `y`. Each block belongs to one of
  /// the parts, selected at random.
  bool renders(int x, int y) const {
    if (first == 0 && end == parts) return true;
    const auto block = static_cast<std::uint64_t>(x / 8) << 28 | static_cast<std::uint64_t>(y / 8);
    const auto part = static_cast<int>(Rng(0, 0, block, Rng::Purpose::passes).below(parts));
    return part >= first && part < end;
  }
  /// The next pass of the iteration; after the last one its `first` is `parts`.
  LearningPass next() const { return {end, end == parts ? parts : 2 * end}; }
  static LearningPass begin(bool divided) { return {0, divided ? 1 : int{parts}}; }
};

/// Rounds of learning (Mueller et al. 2017, 5.2): the first is the first pass, each of the others
/// as long as all before it.
class LearningRounds {
 public:
  /// Adds a pass that rendered `share` of an iteration. True if it ends the round.
  bool add(double share) {
    if (first_ == 0) first_ = share;
    done_ += share;
    if (done_ < length()) return false;
    ++ended_;
    done_ = 0;
    return true;
  }
  std::uint64_t ended() const { return ended_; }
  /// Length of the current round, in iterations; 0 before the first pass.
  double length() const { return std::ldexp(first_, std::max(0, static_cast<int>(ended_) - 1)); }
  /// Length of the round that ended last, in iterations.
  double last_length() const {
    return std::ldexp(first_, std::max(0, static_cast<int>(ended_) - 2));
  }

  void save(ByteWriter& out) const {
    out.put(first_);
    out.put(done_);
    out.put(ended_);
  }
  /// Throws std::runtime_error if the data is not valid.
  void load(ByteReader& in) {
    first_ = in.get<double>();
    done_ = in.get<double>();
    ended_ = in.get<std::uint64_t>();
    const bool begun = first_ > 0 && done_ >= 0 && ended_ < 63 && done_ < length();
    if (!begun && !(first_ == 0 && done_ == 0 && ended_ == 0)) {
      throw std::runtime_error("saved rounds of learning are not valid");
    }
  }

 private:
  double first_ = 0, done_ = 0;  // iterations: of the first round, and so far of the current one
  std::uint64_t ended_ = 0;
};

}  // namespace lacuna
