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

/// Selects an emitter for a point with a probability that depends on intensity, distance, and the
/// directions of emission and of the receiving surface (Conty Estevez and Kulla 2018, "Importance
/// Sampling of Many Lights with Adaptive Tree Splitting", without the splitting). A node has up to
/// eight children; their weights are computed by SIMD:
///
///   weight = intensity max(cos a, least) max(cos b, least) / max(d, r)^2
///
/// with d the distance to the centre of the child's box, r half its diagonal, a the smallest angle
/// between an axis of the child and a direction from its sphere to the point (cos a = 1 within the
/// cone of axes, `least` beyond the reach), and b the same at the receiver. A fraction 2^-16 of
/// each node's selections is uniform, so every emitter has a positive probability at every point.
///
/// For a lamp that is a mesh of many triangles, a descent to the triangle gains little. A bundle is
/// a group of emitters that is small relative to the scene and faces one way. If the point sees it
/// under a small angle, the descent ends there and the emitter is selected by intensity.
class LightTree {
 public:
  LightTree() = default;
  /// The tree does not depend on the number of threads. Intensities must be finite and > 0;
  /// `emitters` may be empty. `extent`: the scene's radius, which limits the size of bundles; 0: no
  /// bundles.
  explicit LightTree(const std::vector<TreeEmitter>& emitters, double extent = 0);

  bool empty() const { return nodes_.empty(); }

  struct Choice {
    std::uint32_t entry = 0;  ///< TreeEmitter::entry
    double probability = 0;   ///< > 0
    double rest = 0;          ///< remainder of `u`: in [0, 1), uniform for every entry
  };
  /// Selects by `u`, uniform in [0, 1), a multiple of 2^-53; `rng` supplies further bits if
  /// probabilities are small. Requires !empty().
  Choice choose(const Receiver& at, double u, Rng& rng) const;
  /// The arguments of choose() for one of many points, and its result.
  struct Request {
    Receiver at;
    double u = 0;
    Rng* rng = nullptr;
    Choice result = {};
  };
  /// choose() for each request. Interleaves the descents, which hides memory latency, with the same
  /// results.
  void choose(std::span<Request> requests) const;

  /// The probability with which choose() returns `entry`, bit-identical; 0 if it is not in the
  /// tree.
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
  static void select_child(const Sums& s, Descent& d);
  void enter(const Sums& s, Descent& d) const;
  void end(Descent& d) const;

  HugeVector<LightNode> nodes_;         // 0: the root
  HugeVector<std::uint32_t> entries_;   // of each node's children that are not nodes
  std::vector<std::uint32_t> parents_;  // of each node: 8 times the parent, plus the child's index
  std::vector<std::uint32_t>
      places_;  // of each entry: 8 times its node, plus its child index; or none
  std::vector<Bundle> bundles_;
  std::vector<std::uint32_t> bundle_of_;  // of each node: index in bundles_; or none
  std::vector<std::uint32_t> member_of_;  // of each entry: its index in its bundle
  std::uint64_t bundled_ = 0;             // entries in bundles
};

}  // namespace lacuna
