#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Calls `body(i)` for i in [0, n) on the pool's threads, `chunk` consecutive numbers on one thread
/// in their order: for bodies that take less time than ThreadPool::for_each() takes for each call.
template <class Body>
void for_each_chunked(const ThreadPool& pool, std::size_t n, std::size_t chunk, Body&& body) {
  pool.for_each(static_cast<int>((n + chunk - 1) / chunk), [&](int k) {
    const std::size_t first = static_cast<std::size_t>(k) * chunk;
    for (std::size_t i = first; i < std::min(n, first + chunk); ++i) body(i);
  });
}

}  // namespace lacuna
