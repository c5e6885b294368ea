#include "analysis/complex/collapse.h"

#include <atomic>
#include <numeric>

#include "analysis/complex/block_set.h"
#include "analysis/complex/border.h"

namespace lacuna {
namespace {

/// One direction and orientation of a layer, for a block. A pair's test looks along `t` at faces of
/// its own kind, and across, at the blocks before it along the other axes, only at faces that a
/// higher dimension took. So blocks must be walked against the orientation along `t`, and either
/// each dimension is taken in a walk of its own, in any order across, or all three at each block in
/// one walk that ascends across.
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

  /// The cubes with a free square.
  [[gnu::always_inline]] void take_cubes(std::size_t index) const {
    remove<T | U | V, U | V>(index, Plane::zero());
  }
  [[gnu::always_inline]] void take_squares(std::size_t index) const {
    const KeptEdges::Block& w = kept_.of(index);
    const ComplexBlock* x = x_ + index;
    const Plane across = x->faces[U | V];
    remove<T | U, U>(index, across | from_low<v>(across, x[-dv_].faces[U | V]) | w.edges[u]);
    remove<T | V, V>(index, across | from_low<u>(across, x[-du_].faces[U | V]) | w.edges[v]);
  }
  [[gnu::always_inline]] void take_edges(std::size_t index) const {
    const KeptEdges::Block& w = kept_.of(index);
    const ComplexBlock* x = x_ + index;
    const Plane eu = x->faces[U], ev = x->faces[V];
    remove<T, 0>(index, eu | ev | from_low<u>(eu, x[-du_].faces[U]) |
                            from_low<v>(ev, x[-dv_].faces[V]) | w.vertices);
  }

 private:
  /// Takes the pairs (f, g) of these types where g is free along t and nothing blocks it.
  /// (Called, it would pass planes through memory, which costs as much as the rest.)
  template <FaceType f, FaceType g>
  [[gnu::always_inline]] void remove(std::size_t index, Plane blocked) const {
    ComplexBlock* x = x_ + index;
    BorderBlock* l = l_ + index;
    constexpr auto fi = static_cast<std::size_t>(f), gi = static_cast<std::size_t>(g);
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
};

class Collapse {
 public:
  Collapse(CubicalComplex& complex, const KeptEdges& kept, LayerObserver* observer,
           const ThreadPool* pool)
      : complex_(complex),
        kept_(kept),
        observer_(observer),
        pool_(pool),
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
      cut_slabs();
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
  using Range = BlockSet::Range;

  std::size_t index(int x, int y, int z) const { return complex_.index(x, y, z); }

  /// Slabs across y and across z that hold about as many candidates each, one a thread: a pass
  /// along one axis is cut across another, so that no pair crosses a cut. One slab where there is
  /// little to do.
  void cut_slabs() {
    constexpr std::size_t worthwhile = 400;  // blocks; a walk with threads costs some 10 us
    for (const int axis : {1, 2}) {
      auto& slabs = slabs_[static_cast<std::size_t>(axis)];
      slabs.clear();
      const std::vector<std::size_t> counts = candidates_.slices(axis);
      const std::size_t all = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
      const auto threads = static_cast<std::size_t>(pool_ != nullptr ? pool_->threads() : 1);
      const std::size_t n = all < worthwhile ? 1 : threads;
      Range slab = candidates_.all();
      std::size_t sum = 0;
      for (std::size_t i = 0; i < counts.size() && slabs.size() + 1 < n; ++i) {
        sum += counts[i];
        if (sum * n < all * (slabs.size() + 1)) continue;
        slab.high[axis] = static_cast<int>(i) + 1;
        slabs.push_back(slab);
        slab.low[axis] = slab.high[axis];
        slab.high[axis] = candidates_.blocks()[axis];
      }
      slabs.push_back(slab);
    }
  }
  bool in_slabs() const { return slabs_[1].size() > 1 || slabs_[2].size() > 1; }

  /// Calls `visit(x, y, z)` for the blocks of a set, in slabs across `axis`.
  template <class F>
  void walk(const BlockSet& set, int axis, int descending, const F& visit) {
    const auto& slabs = slabs_[static_cast<std::size_t>(axis)];
    if (slabs.size() == 1) {
      set.for_each(slabs[0], descending, visit);
    } else {
      pool_->for_each(static_cast<int>(slabs.size()), [&](int i) {
        set.for_each(slabs[static_cast<std::size_t>(i)], descending, visit);
      });
    }
  }
  int long_axis() const { return complex_.blocks().y > complex_.blocks().z ? 1 : 2; }

  /// What is free, and what the observer wants to know of the edges.
  void look(int date) {
    walk(candidates_, long_axis(), -1, [&](int x, int y, int z) {
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
    const auto cubes = [&](int x, int y, int z) {
      border_cubes(complex_, border_, index(x, y, z));
    };
    const auto squares = [&](int x, int y, int z) {
      border_squares(complex_, border_, index(x, y, z));
    };
    const auto edges = [&](int x, int y, int z) {
      const Plane any = border_edges(complex_, border_, index(x, y, z));
      if (!any.any()) return;
      active_.insert(x, y, z);
      // A face at the block's upper end makes a pair with one in the next block.
      if ((any & high_slice<0>()).any()) active_.insert(x + 1, y, z);
      if ((any & high_slice<1>()).any()) active_.insert(x, y + 1, z);
      if ((any & high_slice<2>()).any()) active_.insert(x, y, z + 1);
    };
    in_turn(candidates_, long_axis(), -1, cubes, squares, edges);
  }

  /// Three steps for every block of a set: each in a walk of its own where threads share it, else
  /// all at each block, which is then in the cache.
  template <class A, class B, class C>
  void in_turn(const BlockSet& set, int axis, int descending, const A& a, const B& b, const C& c) {
    if (in_slabs()) {
      walk(set, axis, descending, a);
      walk(set, axis, descending, b);
      walk(set, axis, descending, c);
    } else {
      walk(set, axis, descending, [&](int x, int y, int z) {
        a(x, y, z);
        b(x, y, z);
        c(x, y, z);
      });
    }
  }

  template <int t, int orientation>
  void pass() {
    const Pass<t, orientation> one(complex_, border_, kept_);
    const int axis = t == 0 ? long_axis() : t == 1 ? 2 : 1;
    in_turn(
        active_, axis, orientation == 0 ? t : -1,
        [&](int x, int y, int z) { one.take_cubes(index(x, y, z)); },
        [&](int x, int y, int z) { one.take_squares(index(x, y, z)); },
        [&](int x, int y, int z) { one.take_edges(index(x, y, z)); });
  }

  /// Blocks whose border or whose pairs may differ after this layer: a face depends on faces at
  /// most two cells away.
  bool next_candidates() {
    const BlockSet before = candidates_;
    candidates_.clear();
    std::atomic<bool> any{false};
    walk(before, long_axis(), -1, [&](int x, int y, int z) {
      Plane& changed = border_[index(x, y, z)].changed;
      if (!changed.any()) return;
      any.store(true, std::memory_order_relaxed);
      const Reach reach = reach_of(changed);
      changed = Plane::zero();
      add_candidates({x, y, z}, reach);
    });
    return any;
  }

  void add_candidates(Imath::V3i block, const Reach& reach) {
    const Imath::V3i n = complex_.blocks();
    for (int dz = reach.low.z; dz <= reach.high.z; ++dz) {
      for (int dy = reach.low.y; dy <= reach.high.y; ++dy) {
        for (int dx = reach.low.x; dx <= reach.high.x; ++dx) {
          const Imath::V3i b = block + Imath::V3i(dx, dy, dz);
          if (b.x > 0 && b.y > 0 && b.z > 0 && b.x < n.x - 1 && b.y < n.y - 1 && b.z < n.z - 1) {
            candidates_.insert(b.x, b.y, b.z);
          }
        }
      }
    }
  }

  CubicalComplex& complex_;
  const KeptEdges& kept_;
  LayerObserver* observer_;
  const ThreadPool* pool_;
  std::vector<BorderBlock> border_;
  BlockSet candidates_, active_;
  std::array<std::vector<Range>, 3> slabs_;  // by axis, of y and z
};

}  // namespace

int collapse(CubicalComplex& complex, const KeptEdges& kept, LayerObserver* observer, int layers,
             const ThreadPool* pool) {
  return Collapse(complex, kept, observer, pool).run(layers);
}

}  // namespace lacuna
