#include "analysis/complex/collapse.h"

#include "analysis/complex/block_set.h"
#include "analysis/complex/border.h"

namespace lacuna {
namespace {

/// One direction and orientation of a layer, all dimensions, for a block. Blocks before it along
/// the two other axes are done already and the one towards which pairs are taken is not, so that
/// one walk over the blocks gives what removing each dimension everywhere at once gives: a pair's
/// test looks along `t` at faces of its own kind, and across only at faces that a higher dimension
/// took.
template <int t, int orientation>
class Pass {
 public:
  static constexpr int u = (t + 1) % 3, v = (t + 2) % 3;
  static constexpr FaceType T = 1 << t, U = 1 << u, V = 1 << v;

  Pass(CubicalComplex& complex, std::vector<BorderBlock>& border, const KeptEdges& kept)
      : x_(complex.data()),
        l_(border.data()),
        kept_(kept),
        dt_(complex.stride(t)),
        du_(complex.stride(u)),
        dv_(complex.stride(v)) {}

  void operator()(std::size_t index) {
    x = x_ + index;
    l = l_ + index;
    const KeptEdges::Block& w = kept_.of(index);
    remove(T | U | V, U | V, Plane::zero());
    const Plane across = x->faces[U | V];
    remove(T | U, U, across | from_low<v>(across, x[-dv_].faces[U | V]) | w.edges[u]);
    remove(T | V, V, across | from_low<u>(across, x[-du_].faces[U | V]) | w.edges[v]);
    const Plane eu = x->faces[U], ev = x->faces[V];
    remove(T, 0,
           eu | ev | from_low<u>(eu, x[-du_].faces[U]) | from_low<v>(ev, x[-dv_].faces[V]) |
               w.vertices);
  }

 private:
  /// Takes the pairs (f, g) of these types where g is free along t and nothing blocks it.
  void remove(FaceType f, FaceType g, Plane blocked) {
    const auto fi = static_cast<std::size_t>(f), gi = static_cast<std::size_t>(g);
    const Plane own = x->faces[fi], low = from_low<t>(own, x[-dt_].faces[fi]);
    if constexpr (orientation == 0) {  // g at the low side of f, both at one cell
      const Plane e = own & ~low & l->layer[fi] & ~blocked;
      if (!e.any()) return;
      x->faces[fi] = own & ~e;
      x->faces[gi] &= ~e;
      l->changed |= e;
    } else {  // g at the high side: f is at the cell before
      const Plane e = low & ~own & from_low<t>(l->layer[fi], l[-dt_].layer[fi]) & ~blocked;
      if (!e.any()) return;
      const Plane here = from_high<t>(e, Plane::zero()), before = from_high<t>(Plane::zero(), e);
      x->faces[fi] = own & ~here;
      x->faces[gi] &= ~e;
      x[-dt_].faces[fi] &= ~before;
      l->changed |= e | here;
      l[-dt_].changed |= before;
    }
  }

  ComplexBlock* x_;
  BorderBlock* l_;
  const KeptEdges& kept_;
  std::ptrdiff_t dt_, du_, dv_;
  ComplexBlock* x = nullptr;
  BorderBlock* l = nullptr;
};

class Collapse {
 public:
  Collapse(CubicalComplex& complex, const KeptEdges& kept, LayerObserver* observer)
      : complex_(complex),
        kept_(kept),
        observer_(observer),
        border_(complex.block_count()),
        candidates_(complex.blocks()),
        active_(complex.blocks()) {
    const Imath::V3i n = complex.blocks();
    for (int z = 1; z < n.z - 1; ++z) {
      for (int y = 1; y < n.y - 1; ++y) {
        for (int x = 1; x < n.x - 1; ++x) candidates_.insert(x, y, z);
      }
    }
  }

  int run(int layers) {
    int date = 0;
    for (; !candidates_.empty(); ++date) {
      look(date);
      if (date == layers) break;
      take_border();
      pass<0, 0>(), pass<0, 1>();
      pass<1, 0>(), pass<1, 1>();
      pass<2, 0>(), pass<2, 1>();
      if (!next_candidates()) break;
    }
    return date;
  }

 private:
  std::size_t index(int x, int y, int z) const { return complex_.index(x, y, z); }

  /// What is free, and what the observer wants to know of the edges.
  void look(int date) {
    candidates_.for_each(-1, [&](int x, int y, int z) {
      const std::size_t i = index(x, y, z);
      const std::array<Plane, 3> facets = find_free(complex_, border_, i);
      if (observer_) {
        const auto& f = complex_.data()[i].faces;
        observer_->edges(date, i, {f[1], f[2], f[4]}, facets);
      }
    });
  }

  /// The layer's border, and the blocks where a pair of it may be taken.
  void take_border() {
    active_.clear();
    candidates_.for_each(-1, [&](int x, int y, int z) {
      const std::size_t i = index(x, y, z);
      const Plane any = close_border(complex_, border_, i);
      if (!any.any()) return;
      active_.insert(x, y, z);
      // A face at the block's upper end makes a pair with one in the next block.
      if ((any & high_slice<0>()).any()) active_.insert(x + 1, y, z);
      if ((any & high_slice<1>()).any()) active_.insert(x, y + 1, z);
      if ((any & high_slice<2>()).any()) active_.insert(x, y, z + 1);
    });
  }

  template <int t, int orientation>
  void pass() {
    Pass<t, orientation> one(complex_, border_, kept_);
    active_.for_each(orientation == 0 ? t : -1, [&](int x, int y, int z) { one(index(x, y, z)); });
  }

  /// Blocks whose border or whose pairs may differ after this layer: a face depends on faces at
  /// most two cells away.
  bool next_candidates() {
    const BlockSet before = candidates_;
    candidates_.clear();
    bool any = false;
    const Imath::V3i n = complex_.blocks();
    before.for_each(-1, [&](int x, int y, int z) {
      Plane& changed = border_[index(x, y, z)].changed;
      if (!changed.any()) return;
      any = true;
      const Reach reach = reach_of(changed);
      changed = Plane::zero();
      for (int dz = reach.low.z; dz <= reach.high.z; ++dz) {
        for (int dy = reach.low.y; dy <= reach.high.y; ++dy) {
          for (int dx = reach.low.x; dx <= reach.high.x; ++dx) {
            const Imath::V3i b(x + dx, y + dy, z + dz);
            if (b.x > 0 && b.y > 0 && b.z > 0 && b.x < n.x - 1 && b.y < n.y - 1 && b.z < n.z - 1) {
              candidates_.insert(b.x, b.y, b.z);
            }
          }
        }
      }
    });
    return any;
  }

  CubicalComplex& complex_;
  const KeptEdges& kept_;
  LayerObserver* observer_;
  std::vector<BorderBlock> border_;
  BlockSet candidates_, active_;
};

}  // namespace

int collapse(CubicalComplex& complex, const KeptEdges& kept, LayerObserver* observer, int layers) {
  return Collapse(complex, kept, observer).run(layers);
}

}  // namespace lacuna
