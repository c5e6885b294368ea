#pragma once

#include <exception>

namespace lacuna {

/// An error of the machine that may be over another time without anybody touching what it was met
/// with: no room, inode, quota, memory, process, lock or file descriptor left; a file system that
/// is read-only, fails or is away; a missing permission; a file beyond the size limit.
bool may_pass(int error);
/// The same of an exception: std::bad_alloc, or a std::system_error with such an errno.
bool may_pass(const std::exception& error);

/// The process or the machine has no file descriptor left.
bool is_want_of_descriptors(int error);

}  // namespace lacuna
