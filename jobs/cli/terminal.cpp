#include "jobs/cli/terminal.h"

#include <fmt/format.h>
#include <spdlog/logger.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lacuna {

namespace {

/// Whether standard error is this file, as set by the service.
bool stderr_goes_to(const std::filesystem::path& file) {
  struct stat a {};
  struct stat b {};
  return fstat(STDERR_FILENO, &a) == 0 && stat(file.c_str(), &b) == 0 && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino;
}

std::string duration(double seconds) {
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
  return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

std::string bar_of(const Progress& p, const std::string& phase, int columns) {
  std::string text =
      fmt::format(" {:3.0f} %  iteration {}, {:.1f} s", 100 * p.share, p.iteration, p.seconds);
  if (p.remaining_seconds) text += fmt::format(", {} left", duration(*p.remaining_seconds));
  if (p.error) text += fmt::format(", {} {:.3g}", p.error_metric, *p.error);
  const int width = std::clamp(columns - static_cast<int>(text.size() + phase.size()) - 5, 0, 40);
  const int filled = static_cast<int>(p.share * width);
  return fmt::format("{} [{:#<{}}{:.<{}}]{}", phase, "", filled, "", width - filled, text);
}

int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

Terminal::Terminal(const std::filesystem::path& log, bool quiet)
    : bar_(isatty(STDERR_FILENO) == 1 && !quiet) {
  const auto console = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  const bool to_log = !log.empty() && stderr_goes_to(log);
  console->set_level(quiet ? spdlog::level::warn : spdlog::level::info);
  console->set_pattern(to_log ? "%Y-%m-%d %T.%e %v" : "%v");
  logger_ = std::make_unique<spdlog::logger>("lacuna", console);
  logger_->flush_on(spdlog::level::info);
  if (log.empty() || to_log) return;
  try {
    const auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>(log.string());
    file->set_pattern("%Y-%m-%d %T.%e %v");
    logger_->sinks().push_back(file);
  } catch (const spdlog::spdlog_ex& e) {  // a full or read-only disk, which the job reports, too
    warning(e.what());
  }
}

Terminal::~Terminal() { clear_bar(); }

void Terminal::clear_bar() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

void Terminal::phase(const std::string& name) {
  phase_ = name;
  clear_bar();
  logger_->info("{}", name);
}

void Terminal::progress(const Progress& p) {
  if (bar_) status(bar_of(p, phase_, terminal_columns()));
}

void Terminal::status(const std::string& line) {
  if (!bar_) return;
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
  drawn_ = true;
}

void Terminal::milestone(const std::string& line) {
  clear_bar();
  logger_->info("{}", line);
}

void Terminal::warning(const std::string& line) {
  clear_bar();
  logger_->warn("warning: {}", line);
}

void Terminal::error(const std::string& line) {
  clear_bar();
  logger_->error("error: {}", line);
}

}  // namespace lacuna
