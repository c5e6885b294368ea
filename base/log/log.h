#pragma once

#include <fmt/format.h>

#include <functional>
#include <string_view>
#include <utility>

namespace lacuna::log {

// The log of a program. Only log.cpp includes the library's headers.

enum class Level { debug, info, warning, error };

/// Writes lines to standard error, with the time; `verbose`: debug lines, too.
void start(const char* name, bool verbose);
/// Passes warnings and errors to `sink`, from any thread, and drops other lines.
void start(std::function<void(Level, std::string_view)> sink);
/// Whether lines of `level` are written.
bool shows(Level level);
void write(Level level, std::string_view line);

template <class... Args>
void debug(fmt::format_string<Args...> text, Args&&... args) {
  if (!shows(Level::debug)) return;  // called for every request
  write(Level::debug, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void info(fmt::format_string<Args...> text, Args&&... args) {
  if (!shows(Level::info)) return;
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
