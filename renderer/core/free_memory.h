#pragma once

#include <fmt/format.h>

#include "analysis/space/memory_limit.h"
#include "base/storage/available_memory.h"

namespace lacuna {

/// Throws MemoryLimitError if `bytes` exceed memory_to_take(). `what()` returns their purpose and
/// how to need less. Call it before the allocation.
template <class What>
void require_free(double bytes, What&& what) {
  const auto free = double(memory_to_take());
  if (bytes < free) return;
  throw MemoryLimitError(fmt::format("{}: {:.1f} MiB, of {:.1f} MiB that are available", what(),
                                     bytes / 0x1p20, free / 0x1p20));
}

}  // namespace lacuna
