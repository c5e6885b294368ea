#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/geometry/simd.h"

namespace lacuna {

/// Nodes of one level of a scene's octree, as a structure of arrays: any eight of them fill a
/// register, whatever their parents.
class NodeList {
 public:
  std::vector<float> x, y, z;              ///< centres of the cubes, in the grid of SceneNodes
  std::vector<std::uint32_t> node, shape;  ///< index, and SceneNodes::Node::shape

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }
  /// Sets the number of nodes. Requires memory for them.
  void resize(std::size_t n) { size_ = n; }

  /// Eight nodes from index `i`. Those beyond the end are undefined.
  struct Eight {
    Float8 x, y, z;
    Int8 node, shape;
  };
  Eight eight(std::size_t i) const {
    return {Float8::load_unaligned(&x[i]), Float8::load_unaligned(&y[i]),
            Float8::load_unaligned(&z[i]), Int8::load_unaligned(&node[i]),
            Int8::load_unaligned(&shape[i])};
  }
  /// Allocates memory for appending `more` nodes.
  void make_room(std::size_t more) {
    const std::size_t least = size_ + more + 8;  // whole registers are stored
    if (x.size() >= least) return;
    const std::size_t room = least + least / 2;
    for (auto* v : {&x, &y, &z}) v->resize(room);
    for (auto* v : {&node, &shape}) v->resize(room);
  }
  /// Appends the elements of `e` selected by the mask `lanes`. Requires memory for them.
  void append(const Eight& e, unsigned lanes) {
    const Int8 order = to_front(lanes);
    store({permute(e.x, order), permute(e.y, order), permute(e.z, order), permute(e.node, order),
           permute(e.shape, order)},
          static_cast<std::size_t>(__builtin_popcount(lanes)));
  }
  /// Appends the first `n` elements of `e`. Requires memory for them.
  void store(const Eight& e, std::size_t n) {
    e.x.store_unaligned(&x[size_]);
    e.y.store_unaligned(&y[size_]);
    e.z.store_unaligned(&z[size_]);
    e.node.store_unaligned(&node[size_]);
    e.shape.store_unaligned(&shape[size_]);
    size_ += n;
  }

 private:
  std::size_t size_ = 0;
};

}  // namespace lacuna
