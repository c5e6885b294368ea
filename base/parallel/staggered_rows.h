#pragma once

#include <functional>

#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Runs body(row, column) for rows 0, 1, ... of `columns` >= 1 columns: each after (row, column -
/// 1) and (row - 1, column + 1), so that as many rows overlap as half the columns (time skewing). A
/// row follows while another(row), called once a row is complete, is true; what the others do not
/// depend on of up to `columns` rows after the last may have run by then. In plain order with no
/// pool. The first exception is rethrown, and Stopped thrown between bodies when the pool asks.
void staggered_rows(const ThreadPool* pool, int columns,
                    const std::function<void(int row, int column)>& body,
                    const std::function<bool(int row)>& another);

}  // namespace lacuna
