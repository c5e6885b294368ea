#pragma once

#include <filesystem>

#include "base/parallel/work_log.h"

namespace lacuna {

/// Writes the spans of `log` in Chrome's trace format (JSON, "complete" events; times in
/// microseconds), for chrome://tracing, Perfetto and `./dev bench scaling`. An event's name is its
/// section; `args` have its CPU time, the number of its loop and the index of its body, -1 for
/// serial work. Throws std::system_error.
void write_trace(const WorkLog& log, const std::filesystem::path& file);

}  // namespace lacuna
