#include "base/log/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace lacuna::log {
namespace {

std::function<void(Level, std::string_view)>& sink_of_program() {
  static std::function<void(Level, std::string_view)> sink;
  return sink;
}

spdlog::level::level_enum library_level(Level level) {
  switch (level) {
    case Level::debug:
      return spdlog::level::debug;
    case Level::info:
      return spdlog::level::info;
    case Level::warning:
      return spdlog::level::warn;
    case Level::error:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

void start(const char* name, bool verbose) {
  spdlog::set_default_logger(spdlog::stderr_color_mt(name));
  if (verbose) spdlog::set_level(spdlog::level::debug);
}

void start(std::function<void(Level, std::string_view)> sink) {
  sink_of_program() = std::move(sink);
  spdlog::set_level(spdlog::level::warn);
}

bool shows(Level level) { return spdlog::should_log(library_level(level)); }

void write(Level level, std::string_view line) {
  if (!shows(level)) return;
  if (const auto& sink = sink_of_program()) return sink(level, line);
  spdlog::default_logger_raw()->log(library_level(level),
                                    spdlog::string_view_t(line.data(), line.size()));
}

}  // namespace lacuna::log
