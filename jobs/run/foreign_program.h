#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/spec/foreign_settings.h"

namespace lacuna {

/// The values of placeholders, by name without braces.
using Placeholders = std::map<std::string, std::string, std::less<>>;

/// `text` with each {name} of a placeholder replaced by its value; other braces stay.
std::string fill_in(std::string_view text, const Placeholders& values);

/// The time that a program took.
struct ProgramTime {
  double seconds = 0;      ///< wall clock
  double cpu_seconds = 0;  ///< user and system, of the program and all processes of its group
};

/// Runs `settings.command` with the placeholders filled in, in the working directory of this
/// process; its output is appended to `log`. Throws SceneError if the program is missing, fails,
/// or exceeds the timeout, with the end of its output; Stopped, after killing it, when
/// `interrupted`.
ProgramTime run_program(const ForeignSettings& settings, const Placeholders& values,
                        const std::filesystem::path& log, const std::function<bool()>& interrupted);

}  // namespace lacuna
