#pragma once

#include <string>

namespace lacuna {

/// "0.1.0": the version of the project.
std::string version();

}  // namespace lacuna
