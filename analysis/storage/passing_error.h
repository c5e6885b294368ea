#pragma once

#include <chrono>
#include <exception>
#include <filesystem>

namespace lacuna {

/// An error of the machine that may be over another time without anybody touching what it was met
/// with: no room, inode, quota, memory, process, lock or file descriptor left; a file system that
/// is read-only, fails or is away; a missing permission; a file beyond the size limit; a shared
/// library that is missing or being written (ELIBACC).
bool may_pass(int error);
/// The same of an exception: std::bad_alloc, or a std::system_error with such an errno.
bool may_pass(const std::exception& error);

/// The wait after the n-th fault in a row: 0.25 s that double with each, up to `longest`.
std::chrono::milliseconds pause_after_fault(int n, std::chrono::milliseconds longest);

/// Nothing has this name. False, too, where that cannot be told now: what cannot be looked at is
/// not gone.
bool is_gone(const std::filesystem::path& path);

/// The process or the machine has no file descriptor left.
bool is_want_of_descriptors(int error);

}  // namespace lacuna
