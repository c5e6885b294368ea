#include "analysis/space/sweep.h"

#include <algorithm>

namespace lacuna {

namespace {

constexpr int planes_at_a_time = 16;

/// The cuts of [0, height) into blocks of at least 2 * reach * depth rows, for `threads`.
int block_count(int height, int reach, int threads) {
  if (threads == 1) return 1;
  return std::clamp(height / std::max(1, 2 * reach * planes_at_a_time), 1, 2 * threads);
}

}  // namespace

void run_parallel(const ThreadPool& pool, int n, const std::function<void(int)>& body) {
  if (n > 1 && pool.threads() > 1) {
    pool.for_each(n, body);
  } else {
    for (int i = 0; i < n; ++i) {
      pool.check_stop();
      body(i);
    }
  }
}

void sweep(const PlaneSweep& pass, const ThreadPool& pool) {
  const int height = pass.size.y, depth = pass.size.z;
  const int blocks = block_count(height, pass.reach, pool.threads());
  // With one thread, prepares each plane just before its use, while it is in the cache.
  const int together = blocks == 1 && pool.threads() == 1 ? 1 : planes_at_a_time;
  const auto cut = [&](int b) { return static_cast<int>(std::int64_t{height} * b / blocks); };
  for (int first = 0; first < depth; first += together) {
    const int planes = std::min(together, depth - first);
    const auto plane = [&](int k) {
      return pass.direction == SweepDirection::ascending ? first + k : depth - 1 - first - k;
    };
    if (pass.prepare) run_parallel(pool, planes, [&](int k) { pass.prepare(plane(k)); });
    run_parallel(pool, blocks, [&](int b) {
      for (int k = 0; k < planes; ++k)
        pass.step(plane(k), cut(b) + (b > 0 ? k * pass.reach : 0),
                  cut(b + 1) - (b + 1 < blocks ? k * pass.reach : 0));
    });
    if (pass.reach == 0) continue;
    run_parallel(pool, blocks - 1, [&](int b) {
      for (int k = 1; k < planes; ++k)
        pass.step(plane(k), cut(b + 1) - k * pass.reach, cut(b + 1) + k * pass.reach);
    });
  }
}

}  // namespace lacuna
