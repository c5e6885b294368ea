#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/alias_table.h"
#include "renderer/core/huge_pages.h"
#include "renderer/core/rng.h"
#include "renderer/emitters/emitter_bounds.h"
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
  explicit LightTree(std::vector<TreeEmitter> emitters, double extent = 0);

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
    return nodes_.size() * (sizeof(Node) + 8) + places_.size() * 8 + bundled_ * bytes_bundled;
  }

 private:
  friend class LightTreeBuilder;
  static constexpr int width = 8;
  static constexpr std::uint32_t none = ~0U;
  static constexpr std::uint64_t bytes_bundled = AliasTable::bytes_each + 4;

  /// Eight children: what their weights are computed from, and where they are.
  struct alignas(64) Node {
    std::array<float, width> x{}, y{}, z{};    // centre of the child's box
    std::array<float, width> r{};              // half its diagonal
    std::array<float, width> intensity{};      // over the largest of the node; 0: no child
    std::array<std::uint32_t, width> child{};  // a node, or an entry
    std::array<std::array<std::int8_t, width>, 3> axis{};                    // times 127
    std::array<std::int8_t, width> cos_spread{}, sin_spread{}, cos_reach{};  // times 127
    std::uint8_t leaves = 0;      // a bit for each child that is an entry
    std::uint8_t both_sides = 0;  // a bit for each child that emits along its axes and against them
    std::uint8_t count = 0;
    std::uint8_t bundles = 0;  // a bit for each child that is a node and a bundle
  };
  static_assert(sizeof(Node) == 256);

  struct Bundle {
    AliasTable by_intensity;  // of `entries`, in their order
    std::vector<std::uint32_t> entries;
  };

  struct Geometry;
  struct Weights;
  struct Descent;
  static Geometry geometry(const Node& node, const Receiver& at);
  static void weigh(const Node& node, const Receiver& at, const Geometry& g, Weights& w);
  void descend(const Weights& w, Descent& d) const;
  void draw(Descent& d) const;

  HugeVector<Node> nodes_;              // 0: the root
  std::vector<std::uint32_t> parents_;  // of each node: 8 times the parent, plus the child's place
  std::vector<std::uint32_t> places_;   // of each entry: 8 times its node, plus its place; or none
  std::vector<Bundle> bundles_;
  std::vector<std::uint32_t> bundle_of_;  // of each node: in bundles_; or none
  std::vector<std::uint32_t> member_of_;  // of each entry: its place in its bundle
  std::uint64_t bundled_ = 0;             // entries in bundles
};

}  // namespace lacuna
