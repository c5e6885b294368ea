#pragma once

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "base/storage/bytes.h"

namespace lacuna {

/// Rounds of learning: the first is the first update, each of the others as long as all before it
/// and one more first. Updates may be of parts of an iteration (Tuning: pilots).
class LearningRounds {
 public:
  /// An update of so many iterations, > 0. True: the round has ended, and next() must be called.
  bool add(double iterations) {
    if (first_ == 0) first_ = iterations;
    done_ += iterations;
    return done_ >= length();
  }
  void next() {
    ++ended_;
    done_ = 0;
  }
  std::uint64_t ended() const { return ended_; }
  /// Of this round, in iterations; 0 before the first update.
  double length() const { return std::ldexp(first_, static_cast<int>(ended_)); }

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
  double first_ = 0, done_ = 0;  // iterations in the first round, and so far in this one
  std::uint64_t ended_ = 0;
};

}  // namespace lacuna
