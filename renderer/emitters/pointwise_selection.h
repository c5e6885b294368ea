#pragma once

#include <span>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/emitters/light_tree.h"

namespace lacuna {

/// Selects an emitter for a receiver: emitters in the scene by a light tree, emitters at infinity
/// by power. The probability of infinity follows from their powers, but each kind gets at least
/// 1/8: the power of light from infinity depends on the size of the scene, and little of it arrives
/// indoors.
class PointwiseSelection {
 public:
  struct Infinite {
    std::uint32_t entry;
    double power;  ///< > 0
  };
  /// `power`: the sum over all emitters. `extent`: the scene's radius, as in LightTree. `by_power`:
  /// the selection that ratios are relative to; must outlive this.
  PointwiseSelection(const std::vector<TreeEmitter>& finite, std::span<const Infinite> infinite,
                     double power, double extent, const AliasTable& by_power);
  PointwiseSelection(const PointwiseSelection&) = delete;
  PointwiseSelection& operator=(const PointwiseSelection&) = delete;

  struct Choice {
    std::uint32_t entry = 0;
    /// Its probability over that of the selection by power.
    float ratio = 1;
    Rng::FinePoint at{};  ///< remainder of the numbers: places a point on the emitter
  };
  /// Selects by the numbers `at`; `rng` supplies further bits.
  Choice choose(const Receiver& receiver, const Rng::FinePoint& at, Rng& rng) const;
  /// The arguments of choose() for one of several points, and its result.
  struct Request {
    Receiver receiver;
    Rng* rng = nullptr;  ///< supplies the numbers
    Choice result = {};
  };
  /// choose() for each request, with the same results, but faster.
  void choose(std::span<Request> requests) const;
  /// The ratio that choose() returns with `entry`.
  float ratio(std::uint32_t entry, const Receiver& at) const;

  /// Number of emitters in the scene.
  std::size_t finite() const { return finite_; }
  std::uint64_t bytes() const { return tree_.bytes(); }

 private:
  bool goes_to_infinity(const Rng::FinePoint& at) const {
    return at.u_select < infinite_share_ * 0x1p32;
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
