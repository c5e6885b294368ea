#pragma once

#include <functional>

#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Runs body(row, column) for rows 0, 1, ... of `columns` >= 1 columns, each after (row, column -
/// 1) and (row - 1, column + 1), so that up to columns / 2 rows overlap (time skewing). Calls
/// another(row) after each complete row; false ends the loop. By then bodies of up to `columns`
/// later rows may have run whose dependencies were met. Without a pool, runs row by row. Rethrows
/// the first exception; throws Stopped between bodies if the pool is stopped.
void staggered_rows(const ThreadPool* pool, int columns,
                    const std::function<void(int row, int column)>& body,
                    const std::function<bool(int row)>& another);

}  // namespace lacuna
