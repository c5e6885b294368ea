#include "analysis/complex/collapse.h"

#include <algorithm>
#include <atomic>
#include <memory>

#include "analysis/complex/block_set.h"
#include "analysis/complex/border.h"
#include "analysis/complex/pass.h"
#include "base/parallel/staggered_rows.h"

namespace lacuna {
namespace {

/// The layers of Alg. 2. A layer is one ascending traversal of the slices of blocks across y or z,
/// in `steps` steps, each one slice behind the one before: the adjacent slices that a step reads
/// are past the previous step and, where it matters, not yet past its own or the next. So a block
/// stays in the cache for all steps. Successive layers are staggered in the same way
/// (staggered_rows).
class Collapse {
 public:
  Collapse(CubicalComplex& complex, const KeptEdges& kept, LayerObserver* observer, int layers,
           const ThreadPool* pool)
      : complex_(complex),
        kept_(kept),
        observer_(observer),
        layers_(layers),
        across_(complex.blocks().y > complex.blocks().z ? 1 : 2),
        border_(complex.block_count()),
        active_(complex.blocks()) {
    cut(pool);
    for (std::size_t i = 0; i < columns() + 1; ++i) {
      in_flight_.push_back(std::make_unique<Layer>(complex.blocks(), across_));
    }
    const Imath::V3i n = complex.blocks();
    for (int z = 1; z < n.z - 1; ++z) {
      for (int y = 1; y < n.y - 1; ++y) {
        for (int x = 1; x < n.x - 1; ++x) layer(0).candidates.insert(x, y, z);
      }
    }
  }

  int run(const ThreadPool* pool) {
    int dates = 0;
    staggered_rows(
        pool, static_cast<int>(columns()),
        [&](int date, int column) {
          const auto i = static_cast<std::size_t>(column);
          for (int at = cuts_[i]; at < cuts_[i + 1]; ++at) {
            across_ == 1 ? steps_at<1>(date, at) : steps_at<2>(date, at);
          }
        },
        [&](int date) {
          dates = date;
          return date < layers_ && layer(date).changed.exchange(false);
        });
    return dates;
  }

 private:
  /// The data of a layer in progress.
  struct Layer {
    Layer(Imath::V3i blocks, int across) : candidates(blocks) {
      const auto n =
          static_cast<std::size_t>(blocks.x) * static_cast<std::size_t>(blocks[3 - across]);
      for (auto& slice : taken) slice.resize(n);
    }
    BlockSet candidates;  // where its border or its pairs may differ from the previous layer's
    std::atomic<bool> changed{false};
    std::array<std::vector<TakenFaces>, 2> taken;  // by its pass along `across`, in the last slices
  };

  static constexpr int steps = 9;

  std::size_t columns() const { return cuts_.size() - 1; }
  Layer& layer(int date) { return *in_flight_[static_cast<std::size_t>(date) % in_flight_.size()]; }
  std::size_t index(int x, int y, int z) const { return complex_.index(x, y, z); }

  /// Cuts the positions of the first step into columns of at least `steps`: a layer may begin once
  /// the previous one is `steps` ahead.
  void cut(const ThreadPool* pool) {
    const int begin = 1, end = complex_.blocks()[across_] - 1 + steps;
    const int threads = pool != nullptr ? pool->threads() : 1;
    const int n = threads == 1 ? 1 : std::max(1, (end - begin) / steps);
    for (int i = 0; i <= n; ++i) cuts_.push_back(begin + (end - begin) * i / n);
  }

  template <int across>
  void steps_at(int date, int at) {
    if (date > layers_) return;
    Layer& now = layer(date);
    look(date, now, at);
    if (date == layers_) return;
    take_border(now, at - 1);
    pass<0, 0, across>(now, at - 2), pass<0, 1, across>(now, at - 3);
    pass<1, 0, across>(now, at - 4), pass<1, 1, across>(now, at - 5);
    pass<2, 0, across>(now, at - 6), pass<2, 1, across>(now, at - 7);
    next_candidates(now, layer(date + 1), at - 8);
  }
  bool in_grid(int slice) const { return slice >= 0 && slice < complex_.blocks()[across_]; }

  /// Finds the free faces, and passes the edges to the observer.
  void look(int date, const Layer& now, int slice) {
    if (!in_grid(slice)) return;
    now.candidates.for_each(across_, slice, -1, [&](int x, int y, int z) {
      const std::size_t i = index(x, y, z);
      const std::array<Plane, 3> facets = find_free(complex_, border_, i);
      if (observer_) {
        const auto& f = complex_.data()[i].faces;
        observer_->edges(date, i, {f[1], f[2], f[4]}, facets);
      }
    });
  }

  /// Finds the layer's border, and the blocks in which its pairs may be removed.
  void take_border(const Layer& now, int slice) {
    if (!in_grid(slice)) return;
    now.candidates.for_each(across_, slice, -1, [&](int x, int y, int z) {
      const Plane any = take_border_of(complex_, border_, index(x, y, z));
      if (!any.any()) return;
      active_.insert(x, y, z);
      // A face at the block's upper end pairs with one in the next block.
      if ((any & high_slice<0>()).any()) active_.insert(x + 1, y, z);
      if ((any & high_slice<1>()).any()) active_.insert(x, y + 1, z);
      if ((any & high_slice<2>()).any()) active_.insert(x, y, z + 1);
    });
  }

  template <int t, int orientation, int across>
  void pass(Layer& now, int slice) {
    if (!in_grid(slice)) return;
    const Pass<t, orientation> one(complex_, border_, kept_);
    if constexpr (t == across && orientation == 0) {
      auto& here = now.taken[static_cast<std::size_t>(slice) & 1];
      const auto& before = now.taken[static_cast<std::size_t>(slice + 1) & 1];
      active_.for_each(across, slice, -1, [&](int x, int y, int z) {
        const auto i =
            static_cast<std::size_t>(x) + static_cast<std::size_t>(complex_.blocks().x) *
                                              static_cast<std::size_t>(across == 1 ? z : y);
        const bool active = active_.contains(x, across == 1 ? y - 1 : y, across == 1 ? z : z - 1);
        one.take(index(x, y, z), active ? &before[i] : nullptr, here[i]);
      });
    } else {
      active_.for_each(across, slice, orientation == 0 ? t : -1,
                       [&](int x, int y, int z) { one.take(index(x, y, z)); });
    }
  }

  /// Inserts the blocks whose border or pairs may differ after this layer: a face depends on faces
  /// at most two cells away.
  void next_candidates(Layer& now, Layer& next, int slice) {
    if (!in_grid(slice)) return;
    bool any = false;
    active_.for_each(across_, slice, -1, [&](int x, int y, int z) {
      Plane& changed = border_[index(x, y, z)].changed;
      if (!changed.any()) return;
      any = true;
      const Reach reach = reach_of(changed);
      changed = Plane::zero();
      add_candidates(next, {x, y, z}, reach);
    });
    if (any) now.changed.store(true, std::memory_order_relaxed);
    active_.clear(across_, slice);
    now.candidates.clear(across_, slice);
  }

  void add_candidates(Layer& next, Imath::V3i block, const Reach& reach) {
    const auto inner = [this](int i, int axis) {
      return std::clamp(i, 1, complex_.blocks()[axis] - 2);
    };
    const Imath::V3i low = block + reach.low, high = block + reach.high;
    for (int z = inner(low.z, 2); z <= inner(high.z, 2); ++z) {
      for (int y = inner(low.y, 1); y <= inner(high.y, 1); ++y) {
        next.candidates.insert_row(inner(low.x, 0), inner(high.x, 0), y, z);
      }
    }
  }

  CubicalComplex& complex_;
  const KeptEdges& kept_;
  LayerObserver* observer_;
  const int layers_;
  const int across_;  // the longer axis of y and z
  std::vector<BorderBlock> border_;
  BlockSet active_;
  std::vector<int> cuts_;
  std::vector<std::unique_ptr<Layer>> in_flight_;
};

}  // namespace

int collapse(CubicalComplex& complex, const KeptEdges& kept, LayerObserver* observer, int layers,
             const ThreadPool* pool) {
  return Collapse(complex, kept, observer, layers, pool).run(pool);
}

}  // namespace lacuna
