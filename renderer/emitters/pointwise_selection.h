#pragma once

#include <span>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/emitters/light_tree.h"

namespace lacuna {

/// Selects an emitter for a receiver: by a light tree among those in the scene, by power among
/// those at infinity. Which of the two is decided by their powers, but neither gets less than an
/// eighth: the power of light from infinity depends on the size of the scene, and indoors little of
/// it arrives.
class PointwiseSelection {
 public:
  struct Infinite {
    std::uint32_t entry;
    double power;  ///< > 0
  };
  /// `power`: that of all emitters. `extent`: the scene's radius, as of LightTree. `by_power`: the
  /// selection that ratios are relative to, which outlives this.
  PointwiseSelection(const std::vector<TreeEmitter>& finite, std::span<const Infinite> infinite,
                     double power, double extent, const AliasTable& by_power);
  PointwiseSelection(const PointwiseSelection&) = delete;
  PointwiseSelection& operator=(const PointwiseSelection&) = delete;

  struct Choice {
    std::uint32_t entry = 0;
    /// Its probability over that of selection by power.
    float ratio = 1;
    Rng::FinePoint at{};  ///< what is left of the numbers: places a point on the emitter
  };
  /// By the numbers `at`; `rng` fills them up.
  Choice choose(const Receiver& receiver, const Rng::FinePoint& at, Rng& rng) const;
  /// A request to choose() for one of several points.
  struct Request {
    Receiver receiver;
    Rng* rng = nullptr;  ///< gives the numbers
    Choice result = {};
  };
  /// choose() for each request, with the same results, in less time.
  void choose(std::span<Request> requests) const;
  /// The ratio that choose() states where it returns `entry`.
  float ratio(std::uint32_t entry, const Receiver& at) const;

  /// Number of emitters in the scene.
  std::size_t finite() const { return finite_; }
  std::uint64_t bytes() const { return tree_.bytes(); }

 private:
  bool goes_to_infinity(const Rng::FinePoint& at) const {
    return at.besides < infinite_share_ * 0x1p32;
  }
  Choice choose_infinite(Rng::FinePoint at, Rng& rng) const;
  Choice choose_finite(const LightTree::Choice& c, Rng::FinePoint at) const;
  float relative(std::uint32_t entry, double probability) const {
    return static_cast<float>(probability / double(by_power_.pmf(entry).value));
  }

  const AliasTable& by_power_;
  LightTree tree_;
  std::size_t finite_;
  AliasTable infinite_;
  std::vector<std::uint32_t> infinite_entries_;
  double infinite_share_ = 0;  // a multiple of 2^-32
};

}  // namespace lacuna
