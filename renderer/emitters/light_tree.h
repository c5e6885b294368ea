#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/core/huge_pages.h"
#include "renderer/core/rng.h"
#include "renderer/emitters/emitter_bounds.h"
#include "renderer/emitters/light_node.h"
#include "renderer/emitters/receiver.h"

namespace lacuna {

/// Chooses an emitter for a point with a probability that follows intensity, distance, and the
/// directions of emission and of the receiving surface (Conty Estevez and Kulla 2018, "Importance
/// Sampling of Many Lights with Adaptive Tree Splitting", without the splitting). A node has up to
/// eight children, whose weights are computed side by side:
///
///   weight = intensity max(cos a, least) max(cos b, least) / max(d, r)^2
///
/// with d the distance to the centre of the child's box, r half the diagonal, a the least angle
/// between an axis of the child and a direction from its sphere to the point (1 up to the cone of
/// axes, `least` beyond the reach), and b the same at the receiver. A share 2^-16 of each node's
/// choices is uniform, so no emitter has probability 0, whatever the point.
///
/// Where a lamp is a mesh of many triangles, little is gained by descending to each of them: a
/// bundle is a group of emitters that is small beside the scene and faces one way. For a point that
/// sees it under a small angle the descent ends there, and an emitter is drawn by intensity.
class LightTree {
 public:
  LightTree() = default;
  /// The same tree for any number of threads. Intensities must be finite and > 0; `emitters` may be
  /// empty. `extent`: the scene's radius, that bundles are small beside; 0: without bundles.
  explicit LightTree(const std::vector<TreeEmitter>& emitters, double extent = 0);

  bool empty() const { return nodes_.empty(); }

  struct Choice {
    std::uint32_t entry = 0;  ///< TreeEmitter::entry
    double probability = 0;   ///< > 0
    double rest = 0;          ///< of `u`: in [0, 1), uniform whatever the entry
  };
  /// By `u`, uniform in [0, 1), a multiple of 2^-53; `rng` fills it up where probabilities are
  /// small. Requires !empty().
  Choice choose(const Receiver& at, double u, Rng& rng) const;
  /// A request to choose() for one of many points.
  struct Request {
    Receiver at;
    double u = 0;
    Rng* rng = nullptr;
    Choice result = {};
  };
  /// choose() for each request. The descents are interleaved, which hides their latencies; the
  /// results are the same.
  void choose(std::span<Request> requests) const;

  /// The probability with which choose() returns `entry`; the same number. 0: not in the tree.
  double probability(std::uint32_t entry, const Receiver& at) const;

  std::uint64_t bytes() const {
    return nodes_.size() * bytes_node + places_.size() * 8 + bundled_ * bytes_bundled;
  }

 private:
  friend class LightTreeBuilder;
  static constexpr int width = LightNode::width;
  static constexpr std::uint32_t none = ~0U;
  static constexpr std::uint64_t bytes_node = sizeof(LightNode) + 4 * width + 8;
  static constexpr std::uint64_t bytes_bundled = AliasTable::bytes_each + 4;

  struct Bundle {
    AliasTable by_intensity;  // of `entries`, in their order
    std::vector<std::uint32_t> entries;
  };

  struct Geometry;
  struct Sums;
  enum class State : std::uint8_t;
  struct Descent;
  static Geometry geometry(const LightNode& node, const Receiver& at);
  static void weigh(const LightNode& node, const Receiver& at, Geometry& g);
  static void add_up(const LightNode& node, const Geometry& g, Sums& s);
  static void sum_up(const LightNode& node, const Receiver& at, Sums& s);
  static void pick(const Sums& s, Descent& d);
  void enter(const Sums& s, Descent& d) const;
  void end(Descent& d) const;

  HugeVector<LightNode> nodes_;         // 0: the root
  HugeVector<std::uint32_t> entries_;   // of each node's children, where they are none themselves
  std::vector<std::uint32_t> parents_;  // of each node: 8 times the parent, plus the child's place
  std::vector<std::uint32_t> places_;   // of each entry: 8 times its node, plus its place; or none
  std::vector<Bundle> bundles_;
  std::vector<std::uint32_t> bundle_of_;  // of each node: in bundles_; or none
  std::vector<std::uint32_t> member_of_;  // of each entry: its place in its bundle
  std::uint64_t bundled_ = 0;             // entries in bundles
};

}  // namespace lacuna
