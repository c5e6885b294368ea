#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <system_error>

namespace lacuna {

/// Whether an errno is transient: a later attempt may succeed without a change to the file or
/// program. No space, inode, quota, memory, process, lock or file descriptor left; a file system
/// that is read-only, failing or unavailable; a missing permission; a file beyond the size limit; a
/// shared library that is missing or being written (ELIBACC).
bool may_pass(int error);

/// An input file of a picture cannot be opened or read for a transient reason (input_file.h). The
/// errno may be ENOENT: the folder is unavailable.
class InputUnreadable : public std::system_error {
 public:
  InputUnreadable(int error, const std::string& what)
      : std::system_error(error, std::generic_category(), what) {}
};

/// The same for an exception: std::bad_alloc, InputUnreadable, or a std::system_error with such an
/// errno.
bool may_pass(const std::exception& error);

/// The wait after the n-th error in a row: 0.25 s, doubled with each error, at most `longest`.
std::chrono::milliseconds pause_after_fault(int n, std::chrono::milliseconds longest);

/// Whether no file has this name; false if this cannot be determined now.
bool is_gone(const std::filesystem::path& path);

/// Whether the process or the machine has no file descriptor left.
bool is_want_of_descriptors(int error);

}  // namespace lacuna
