#include "base/storage/passing_error.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <new>

namespace lacuna {

bool may_pass(int error) {
  // EPERM: a file that was made immutable; EFBIG: beyond RLIMIT_FSIZE; from ENOLCK to EREMOTEIO:
  // file systems of other machines.
  constexpr std::array passing{ENOSPC,    EDQUOT,       EROFS,     EFBIG,     EIO,
                               EACCES,    EPERM,        EMFILE,    ENFILE,    EAGAIN,
                               ENOMEM,    ENOLCK,       ESTALE,    ETIMEDOUT, ENOTCONN,
                               EHOSTDOWN, EHOSTUNREACH, EREMOTEIO, ELIBACC};
  return std::find(passing.begin(), passing.end(), error) != passing.end();
}

bool may_pass(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return true;
  if (dynamic_cast<const InputUnreadable*>(&error) != nullptr) return true;
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return system != nullptr && may_pass(system->code().value());
}

std::chrono::milliseconds pause_after_fault(int n, std::chrono::milliseconds longest) {
  constexpr std::chrono::milliseconds first{250};
  return std::min(longest, first * (1 << std::clamp(n - 1, 0, 10)));
}

bool is_gone(const std::filesystem::path& path) {
  std::error_code unknown;
  return std::filesystem::status(path, unknown).type() == std::filesystem::file_type::not_found;
}

bool is_want_of_descriptors(int error) { return error == EMFILE || error == ENFILE; }

}  // namespace lacuna
