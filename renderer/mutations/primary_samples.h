#pragma once

#include <cmath>
#include <vector>

#include "renderer/core/rng.h"

namespace lacuna {

/// The random words of one stream of a Markov chain: a point in primary sample space (Kelemen et
/// al. 2002, "A simple and robust mutation strategy for the Metropolis light transport algorithm";
/// Noel 2015, 4.6). A proposal is read as a stream of random numbers, and then accepted or dropped.
///
/// Words beyond those read from the current point are independent of it, and are generated when
/// they are read.
class PrimarySamples final : public RandomWords {
 public:
  /// Proposes a new point, independent of the current one: a large step. `rng` must stay valid
  /// while the proposal is read.
  void propose_fresh(Rng& rng) { propose(rng, 0, 0); }
  /// Proposes a point near the current one: each number moves by at most `distance`, in [0, 1), on
  /// the unit torus.
  void propose_near(Rng& rng, double distance) { propose(rng, kept_, distance); }
  /// The proposal, as far as it was read, becomes the current point.
  void accept() {
    std::swap(current_, proposed_);
    kept_ = read_;
  }

  void next(Block& out) override {
    if (proposed_.size() == read_) proposed_.emplace_back();
    if (read_ < near_) {
      out = current_[read_];
      if (distance_ > 0) {
        for (std::uint32_t& word : out) word += offset(rng_->next_u32());
      }
    } else {
      for (std::uint32_t& word : out) word = rng_->next_u32();
    }
    proposed_[read_++] = out;
  }

 private:
  void propose(Rng& rng, std::size_t near, double distance) {
    rng_ = &rng;
    near_ = near;
    distance_ = static_cast<std::uint32_t>(std::ldexp(distance, 32));
    read_ = 0;
  }

  /// A uniform offset in both directions, up to distance_.
  std::uint32_t offset(std::uint32_t by) const {
    const auto distance =
        static_cast<std::uint32_t>((std::uint64_t{by} << 1 & 0xffffffffU) * distance_ >> 32);
    return (by >> 31) != 0 ? distance : 0U - distance;
  }

  Rng* rng_ = nullptr;
  std::uint32_t distance_ = 0;                  // 2^-32
  std::size_t near_ = 0, read_ = 0, kept_ = 0;  // blocks
  std::vector<Block> current_, proposed_;
};

}  // namespace lacuna
