#pragma once

#include <filesystem>
#include <string>

namespace lacuna {

/// The program's file in PATH, or the absolute path of `name` if it has a '/'; empty if there is
/// none that can be executed.
std::filesystem::path find_program(const std::string& name);

}  // namespace lacuna
