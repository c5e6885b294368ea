#pragma once

#include "analysis/complex/border.h"
#include "analysis/complex/cubical_complex.h"
#include "analysis/complex/kept_edges.h"

namespace lacuna {

/// The faces that a pass removed from a block along its axis: cubes, both types of squares, edges.
using TakenFaces = std::array<Plane, 4>;

/// One axis t and orientation of a layer (thesis Alg. 2, lines 5 to 8), for a block: removes its
/// free pairs, of dimension 3, then 2, then 1, each in all blocks at once. The test of a pair reads
/// faces of its own type along t and, in the preceding blocks along the other axes, faces that only
/// a higher dimension removes. So one traversal may remove all three in each block: ascending
/// across t, and along t against the orientation, or with the faces removed from the preceding
/// block.
template <int t, int orientation>
class Pass {
 public:
  Pass(CubicalComplex& complex, std::vector<BorderBlock>& border, const KeptEdges& kept)
      : x_(complex.data()),
        l_(border.data()),
        kept_(kept),
        dt_(complex.stride(t)),
        du_(complex.stride(u)),
        dv_(complex.stride(v)) {}

  void take(std::size_t index) const { all(index, nullptr, nullptr); }
  /// For a traversal that ascends along t although the orientation is 0: `before` holds the faces
  /// that the pass removed from the preceding block along t (null: none); sets `here` to those
  /// removed now.
  void take(std::size_t index, const TakenFaces* before, TakenFaces& here) const {
    all(index, before, &here);
  }

 private:
  static constexpr int u = (t + 1) % 3, v = (t + 2) % 3;
  static constexpr FaceType T = 1 << t, U = 1 << u, V = 1 << v;

  [[gnu::always_inline]] void all(std::size_t index, const TakenFaces* before,
                                  TakenFaces* here) const {
    const KeptEdges::Block& w = kept_.of(index);
    const ComplexBlock* x = x_ + index;
    remove<0, T | U | V, U | V>(index, Plane::zero(), before, here);
    const Plane across = x->faces[U | V];
    remove<1, T | U, U>(index, across | from_low<v>(across, x[-dv_].faces[U | V]) | w.edges[u],
                        before, here);
    remove<2, T | V, V>(index, across | from_low<u>(across, x[-du_].faces[U | V]) | w.edges[v],
                        before, here);
    const Plane eu = x->faces[U], ev = x->faces[V];
    remove<3, T, 0>(index,
                    eu | ev | from_low<u>(eu, x[-du_].faces[U]) |
                        from_low<v>(ev, x[-dv_].faces[V]) | w.vertices,
                    before, here);
  }

  /// Removes the pairs (f, g) of these types where g is free along t and not blocked. (Always
  /// inline: a call passes planes through memory, which costs as much as the rest.)
  template <std::size_t kind, FaceType f, FaceType g>
  [[gnu::always_inline]] void remove(std::size_t index, Plane blocked, const TakenFaces* before,
                                     TakenFaces* here) const {
    ComplexBlock* x = x_ + index;
    BorderBlock* l = l_ + index;
    constexpr auto fi = static_cast<std::size_t>(f), gi = static_cast<std::size_t>(g);
    const Plane own = x->faces[fi];
    Plane below = x[-dt_].faces[fi];
    if (before != nullptr) below |= (*before)[kind];
    const Plane low = from_low<t>(own, below);
    if constexpr (orientation == 0) {  // g at the low side of f, both at one cell
      const Plane e = own & ~low & l->layer(f) & ~blocked;
      if (here != nullptr) (*here)[kind] = e;
      if (!e.any()) return;
      x->faces[fi] = own & ~e;
      x->faces[gi] &= ~e;
      l->changed |= e;
    } else {  // g at the high side: f is at the cell before
      const Plane e = low & ~own & from_low<t>(l->layer(f), l[-dt_].layer(f)) & ~blocked;
      if (!e.any()) return;
      const Plane mine = from_high<t>(e, Plane::zero()), theirs = from_high<t>(Plane::zero(), e);
      x->faces[fi] = own & ~mine;
      x->faces[gi] &= ~e;
      x[-dt_].faces[fi] &= ~theirs;
      l->changed |= e | mine;
      l[-dt_].changed |= theirs;
    }
  }

  ComplexBlock* x_;
  BorderBlock* l_;
  const KeptEdges& kept_;
  std::ptrdiff_t dt_, du_, dv_;
};

}  // namespace lacuna
