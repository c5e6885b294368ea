#include "server/telemetry/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace lacuna::log {
namespace {

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

bool shows(Level level) { return spdlog::should_log(library_level(level)); }

void write(Level level, std::string_view line) {
  spdlog::default_logger_raw()->log(library_level(level),
                                    spdlog::string_view_t(line.data(), line.size()));
}

}  // namespace lacuna::log
