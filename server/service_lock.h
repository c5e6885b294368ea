#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "analysis/storage/file_lock.h"

namespace lacuna {

/// Keeps a data folder to one service. The lock is on a file, which somebody may remove: then
/// another service can take a new file of that name. So each looks at intervals whether its file is
/// still the one that has the name. The older service leaves a note beside it and goes on; the
/// younger, which finds the note or an older name in the file, ends.
class ServiceLock {
 public:
  /// Throws std::runtime_error if another service works in `data`, std::system_error.
  explicit ServiceLock(std::filesystem::path data);

  /// Why this service has to end; empty: it may go on. Throws std::system_error.
  std::string look();

 private:
  std::string check_note() const;

  const std::filesystem::path data_, file_, note_;
  std::optional<FileLock> lock_;
};

}  // namespace lacuna
