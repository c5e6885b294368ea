#include "jobs/store/new_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <sys/stat.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "base/storage/file_handle.h"

namespace lacuna {
namespace {

/// Renames a complete new folder to its name, which must not exist.
void rename_folder(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return;
  if (errno == EINVAL || errno == ENOSYS) {  // a file system without that flag
    if (std::filesystem::exists(std::filesystem::symlink_status(to))) {
      errno = EEXIST;
    } else if (::rename(from.c_str(), to.c_str()) == 0) {
      return;
    }
  }
  if (errno == EEXIST) throw std::invalid_argument(fmt::format("{} already exists", to.string()));
  throw_file_error(errno, "create", to);
}

}  // namespace

std::filesystem::path folder_path(const std::filesystem::path& named) {
  std::filesystem::path folder = std::filesystem::absolute(named).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();  // "jobs/x/" is "jobs/x"
}

void create_folder_whole(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path& draft)>& fill) {
  std::filesystem::create_directories(target.parent_path());
  const std::filesystem::path draft = temporary_name(target);
  if (::mkdir(draft.c_str(), 0777) != 0) throw_file_error(errno, "create", target);
  try {
    fill(draft);
    rename_folder(draft, target);
  } catch (...) {
    std::error_code ignored;  // the first error is reported
    std::filesystem::remove_all(draft, ignored);
    throw;
  }
  try {
    sync_folder(target.parent_path());
  } catch (const std::system_error&) {
    if (take_folder_back(target)) throw;
  }
}

bool take_folder_back(const std::filesystem::path& folder) {
  const std::filesystem::path hidden = temporary_name(folder);
  if (::rename(folder.c_str(), hidden.c_str()) != 0) return false;
  std::error_code ignored;  // it only takes space
  std::filesystem::remove_all(hidden, ignored);
  return true;
}

std::vector<std::filesystem::path> take_folders_away(
    const std::vector<std::filesystem::path>& folders) {
  std::vector<std::filesystem::path> hidden;
  const auto put_back = [&] {
    bool all = true;
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      all = ::rename(hidden[i].c_str(), folders[i].c_str()) == 0 && all;
    }
    return all;
  };
  for (const auto& folder : folders) {
    const std::filesystem::path name = temporary_name(folder);
    if (::rename(folder.c_str(), name.c_str()) != 0) {
      const int error = errno;
      put_back();
      throw_file_error(error, "remove", folder);
    }
    hidden.push_back(name);
  }
  try {
    if (!folders.empty()) sync_folder(folders.front().parent_path());
  } catch (const std::system_error&) {
    if (put_back()) throw;
  }
  return hidden;
}

void remove_folder_whole(const std::filesystem::path& folder) {
  for (const auto& hidden : take_folders_away({folder})) std::filesystem::remove_all(hidden);
}

}  // namespace lacuna
