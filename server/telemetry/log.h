#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace lacuna::log {

// The service's log, on standard error; no source but log.cpp pays for the library's headers.

enum class Level { debug, info, warning, error };

/// Sets the log up; `verbose`: debug lines are shown too.
void start(const char* name, bool verbose);
/// Whether lines of `level` are written at all.
bool shows(Level level);
void write(Level level, std::string_view line);

template <class... Args>
void debug(fmt::format_string<Args...> text, Args&&... args) {
  if (!shows(Level::debug)) return;  // every request comes by here
  write(Level::debug, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void info(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::info, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void warn(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::warning, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void error(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::error, fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace lacuna::log
