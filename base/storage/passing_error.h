#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>

namespace lacuna {

/// An error of the machine that may be over another time without anybody touching what it was met
/// with: no room, inode, quota, memory, process, lock or file descriptor left; a file system that
/// is read-only, fails or is away; a missing permission; a file beyond the size limit; a shared
/// library that is missing or being written (ELIBACC).
bool may_pass(int error);

/// A file that a picture is made from cannot be opened or read now, for a reason that may pass
/// (input_file.h). The errno may be ENOENT: the folder is away.
class InputUnreadable : public std::system_error {
 public:
  InputUnreadable(int error, const std::string& what)
      : std::system_error(error, std::generic_category(), what) {}
};

/// The same of an exception: std::bad_alloc, InputUnreadable, or a std::system_error with such an
/// errno.
bool may_pass(const std::exception& error);

/// The wait after the n-th fault in a row: 0.25 s that double with each, up to `longest`.
std::chrono::milliseconds pause_after_fault(int n, std::chrono::milliseconds longest);

/// Nothing has this name. False, too, where that cannot be told now: what cannot be looked at is
/// not gone.
bool is_gone(const std::filesystem::path& path);

/// The process or the machine has no file descriptor left.
bool is_want_of_descriptors(int error);

}  // namespace lacuna
