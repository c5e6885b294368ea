#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "jobs/run/observer.h"

namespace spdlog {
class logger;
}

namespace lacuna {

/// Shows a job's progress on standard error: a progress bar on a terminal, otherwise a line per
/// milestone. Also logs to a file, unless standard error is that file.
class Terminal final : public Observer {
 public:
  /// `log` empty: no file. `quiet`: nothing but warnings and errors on standard error.
  Terminal(const std::filesystem::path& log, bool quiet);
  ~Terminal() override;

  void phase(const std::string& name) override;
  void progress(const Progress& p) override;
  void milestone(const std::string& line) override;
  void warning(const std::string& line) override;
  void error(const std::string& line);
  /// Shows a line that the next one replaces; on a terminal only.
  void status(const std::string& line);
  /// Whether status() shows anything.
  bool shows_status() const { return bar_; }

 private:
  void clear_bar();
  std::unique_ptr<spdlog::logger> logger_;
  bool bar_;  // standard error is a terminal
  bool drawn_ = false;
  std::string phase_;
};

}  // namespace lacuna
