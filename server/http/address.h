#pragma once

#include <string>

namespace lacuna {

/// The numeric IP address of `name`: itself, or 127.0.0.1 for "localhost". Throws
/// std::invalid_argument for any other name.
std::string numeric_address(const std::string& name);

/// Whether only this machine can reach the address: 127.0.0.0/8 or ::1. Throws as
/// numeric_address().
bool is_loopback(const std::string& name);

}  // namespace lacuna
