#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "renderer/many_lights/vpl_set.h"

namespace lacuna {

/// Binary trees over the virtual lights of an iteration, down to single lights: one for each number
/// of edges and kind of lights. A node has consecutive lights in the order of the blocks, and is
/// divided where the sum over its parts of intensity times squared size is least.
class VplTree {
 public:
  enum class Kind : std::uint8_t {
    diffuse,   ///< of DiffuseBlock, with normals
    point,     ///< at a position, and any light from a vertex that is not Lambertian
    infinite,  ///< at infinity
  };
  struct Node {
    BlockBounds bounds;
    float intensity = 0;           ///< sum of the lights' luminances; > 0
    std::uint32_t first = 0, end;  ///< numbers of the lights, in the order of blocks
    std::uint32_t child = 0;       ///< the first of two children, the other follows; 0: one light
    Kind kind = Kind::diffuse;
    bool exact = true;  ///< `intensity` and `bounds` bound the lights' emission
  };

  /// `range`: the blocks whose lights are in the trees. The trees do not depend on the number of
  /// threads.
  VplTree(const VplSet& lights, const ThreadPool& pool, const BlockRange& range = {});

  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  /// All nodes, parents before their children.
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const std::uint32_t> roots() const { return roots_; }
  /// The number of lights.
  std::size_t size() const { return blocks_.size(); }
  std::uint32_t block(std::uint32_t light) const { return blocks_[light]; }
  /// Index of a light in its block.
  int lane(std::uint32_t light) const {
    return static_cast<int>(light - first_of_block_[blocks_[light]]);
  }
  float intensity(std::uint32_t light) const {
    return static_cast<float>(sums_[light + 1] - sums_[light]);
  }
  /// The light of `node` for u in [0, 1): probabilities are proportional to intensities.
  std::uint32_t choose(const Node& node, double u) const;

 private:
  struct Item {
    BlockBounds bounds;
    float intensity;
    Kind kind;
    bool exact;
  };
  /// A node without children yet, and the place in nodes_ of all nodes below it.
  struct Subtree {
    std::uint32_t node, below;
  };
  static Item item(const VplSet& lights, std::size_t block, int i);
  std::vector<Item> items(const VplSet& lights, const BlockRange& range, const ThreadPool& pool);
  std::vector<Subtree> add_roots(const VplSet& lights, std::span<const Item> items);
  void build(std::vector<Subtree> subtrees, std::span<const Item> items, const ThreadPool& pool);
  void build(const Subtree& tree, std::span<const Item> items);
  std::optional<std::array<Subtree, 2>> divide(const Subtree& tree, std::span<const Item> items);
  std::uint32_t split(const Node& node, std::span<const Item> items);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> roots_;
  std::vector<std::uint32_t> blocks_;          // of each light
  std::vector<std::uint32_t> first_of_block_;  // number of its first light
  std::vector<double> sums_;                   // of intensities before each light, and of all
  std::vector<double> costs_;                  // split(): of the lights from each on
};

}  // namespace lacuna
