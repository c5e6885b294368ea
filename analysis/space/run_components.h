#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/geometry/disjoint_sets.h"
#include "analysis/geometry/grid.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/sweep.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

enum class Connectivity { faces, corners };  ///< 6: through shared faces; 26: shared corners

/// The component of voxels in no component.
inline constexpr std::uint32_t no_component = 0xffffffff;

/// Voxels [x0, x1) of one line along x, all in one component.
struct ComponentRun {
  std::uint16_t x0, x1;
  std::uint32_t component;
};

/// Connected components of voxels as runs along x: never larger than a label for every voxel, and
/// mostly far smaller. Components are numbered by their first voxel, x fastest.
struct RunComponents {
  Imath::V3i size{0};
  std::vector<std::uint32_t> first;  ///< rows + 1 offsets into `runs`; row (y, z) is z * size.y + y
  std::vector<ComponentRun> runs;    ///< ascending along each row, disjoint
  std::vector<std::uint32_t> first_run;  ///< of each component

  std::size_t count() const { return first_run.size(); }
  std::size_t row(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) +
           static_cast<std::size_t>(y);
  }
  /// The component of a voxel of the grid, or no_component.
  std::uint32_t at(Imath::V3i v) const {
    const auto begin = runs.begin() + first[row(v.y, v.z)],
               end = runs.begin() + first[row(v.y, v.z) + 1];
    const auto after = std::upper_bound(begin, end, v.x,
                                        [](int x, const ComponentRun& run) { return x < run.x0; });
    if (after == begin || v.x >= (after - 1)->x1) return no_component;
    return (after - 1)->component;
  }
  /// Calls visit(run, y, z) for every run, x fastest.
  template <class Visit>
  void for_each_run(const Visit& visit) const {
    std::uint32_t i = 0;
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (; i < first[row(y, z) + 1]; ++i) visit(runs[i], y, z);
  }
};

/// Rows whose runs are voxels of one value, as Rows of label_runs(): value(voxel) is `none` where a
/// voxel is in no run. Runs are linked where their values are equal.
template <class Value>
class EqualValueRows {
  Value value_;
  decltype(std::declval<Value>()(Imath::V3i())) none_;
  int width_;
  Imath::V3i here_{0}, before_{0};

 public:
  EqualValueRows(Value value, decltype(none_) none, int width)
      : value_(value), none_(none), width_(width) {}
  template <class Visit>
  void for_each_run(int y, int z, const Visit& visit) {
    for (int x = 0; x < width_;) {
      const auto value = value_({x, y, z});
      int end = x + 1;
      while (end < width_ && value_({end, y, z}) == value) ++end;
      if (value != none_) visit(x, end);
      x = end;
    }
  }
  void read_links(int y, int z, int axis) {
    here_ = before_ = {0, y, z};
    --before_[axis];
  }
  bool linked(const ComponentRun& here, const ComponentRun& before) const {
    return value_(here_ + Imath::V3i(here.x0, 0, 0)) ==
           value_(before_ + Imath::V3i(before.x0, 0, 0));
  }
};

/// Finds the runs of a grid and joins those that touch: union-find by index, where `component` is
/// the index of a run of the same component, not after its own. `Rows` as for label_runs().
template <class Rows>
class RunLabeller {
  RunComponents& c_;
  const Rows& rows_;
  const int reach_;  // along y and x, to the plane or row before
  const ThreadPool& pool_;

  void join_rows(Rows& source, std::size_t here, std::size_t before) {
    const auto link = [this](std::uint32_t i) -> std::uint32_t& { return c_.runs[i].component; };
    std::uint32_t a = c_.first[here], b = c_.first[before];
    const std::uint32_t a_end = c_.first[here + 1], b_end = c_.first[before + 1];
    while (a < a_end && b < b_end) {
      const ComponentRun &p = c_.runs[a], &q = c_.runs[b];
      if (p.x0 < q.x1 + reach_ && q.x0 < p.x1 + reach_ && source.linked(p, q))
        join_sets(a, b, link);
      // Runs of a row are disjoint, so the one that ends first touches no later run.
      ++(p.x1 <= q.x1 ? a : b);
    }
  }

 public:
  RunLabeller(RunComponents& c, const Rows& rows, Connectivity connectivity, const ThreadPool& pool)
      : c_(c), rows_(rows), reach_(connectivity == Connectivity::corners ? 1 : 0), pool_(pool) {}

  /// Counts the runs of each row and converts the counts to offsets.
  void count_runs(std::uint64_t byte_limit) {
    const auto rows = static_cast<std::size_t>(c_.size.y) * static_cast<std::size_t>(c_.size.z);
    require_memory("components", c_.size, (rows + 1) * sizeof(std::uint32_t), byte_limit);
    c_.first.assign(rows + 1, 0);
    run_parallel(pool_, c_.size.z, [&](int z) {
      Rows source = rows_;
      for (int y = 0; y < c_.size.y; ++y)
        source.for_each_run(y, z, [&](int, int) { ++c_.first[c_.row(y, z) + 1]; });
    });
    std::uint64_t runs = 0;
    for (std::uint32_t& offset : c_.first) {
      runs += offset;
      offset = static_cast<std::uint32_t>(std::min<std::uint64_t>(runs, no_component));
    }
    if (runs >= no_component)
      throw MemoryLimitError("components: more than 2^32 - 2 runs of voxels");
    require_memory("components", c_.size,
                   (rows + 1) * sizeof(std::uint32_t) + runs * sizeof(ComponentRun), byte_limit);
    c_.runs.resize(runs);
  }
  /// Every run becomes its own root.
  void fill_runs() {
    run_parallel(pool_, c_.size.z, [&](int z) {
      Rows source = rows_;
      for (int y = 0; y < c_.size.y; ++y) {
        std::uint32_t i = c_.first[c_.row(y, z)];
        source.for_each_run(y, z, [&](int x0, int x1) {
          c_.runs[i] = {static_cast<std::uint16_t>(x0), static_cast<std::uint16_t>(x1), i};
          ++i;
        });
      }
    });
  }
  /// Joins runs within slabs of planes in parallel, then across their boundaries.
  void join_runs() {
    const auto join_within = [&](int z) {
      Rows source = rows_;
      for (int y = 1; y < c_.size.y; ++y) {
        source.read_links(y, z, 1);
        join_rows(source, c_.row(y, z), c_.row(y - 1, z));
      }
    };
    const auto join_to_before = [&](int z) {
      Rows source = rows_;
      for (int y = 0; y < c_.size.y; ++y) {
        source.read_links(y, z, 2);
        for (int from = std::max(0, y - reach_); from <= std::min(c_.size.y - 1, y + reach_);
             ++from)
          join_rows(source, c_.row(y, z), c_.row(from, z - 1));
      }
    };
    const int depth = c_.size.z;
    const int slabs = std::min(depth, pool_.threads() == 1 ? 1 : 4 * pool_.threads());
    const auto cut = [&](int s) { return static_cast<int>(std::int64_t{depth} * s / slabs); };
    run_parallel(pool_, slabs, [&](int s) {
      for (int z = cut(s); z < cut(s + 1); ++z) {
        join_within(z);
        if (z > cut(s)) join_to_before(z);
      }
    });
    for (int s = 1; s < slabs; ++s) join_to_before(cut(s));
  }
  /// Replaces roots by component numbers. A root precedes the runs that point to it.
  void number_components() {
    for (std::uint32_t i = 0; i < c_.runs.size(); ++i) {
      std::uint32_t& component = c_.runs[i].component;
      if (component == i) {
        component = static_cast<std::uint32_t>(c_.first_run.size());
        c_.first_run.push_back(i);
      } else {
        component = c_.runs[component].component;  // already numbered
      }
    }
  }
};

/// The components of a grid of `size`. Throws MemoryLimitError if they would take more than
/// `byte_limit` bytes, std::invalid_argument on a side above max_grid_side. `Rows` says what the
/// runs are; each thread has a copy:
///   for_each_run(y, z, visit)  calls visit(x0, x1) for the runs of a row, ascending;
///   read_links(y, z, axis)     selects row (y, z) and the one before it along `axis` (1: y, 2: z);
///   linked(here, before)       whether touching runs of these rows are of one component; for
///                              Connectivity::corners always true.
template <class Rows>
RunComponents label_runs(Imath::V3i size, const Rows& rows, Connectivity connectivity,
                         const ThreadPool& pool, std::uint64_t byte_limit = no_memory_limit) {
  RunComponents c;
  c.size = size;
  if (checked_voxels(size) == 0) {
    c.first.assign(1, 0);
    return c;
  }
  RunLabeller<Rows> labeller(c, rows, connectivity, pool);
  labeller.count_runs(byte_limit);
  labeller.fill_runs();
  labeller.join_runs();
  labeller.number_components();
  return c;
}

}  // namespace lacuna
