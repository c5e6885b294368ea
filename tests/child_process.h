#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>

namespace lacuna {

/// Runs `action` in a forked child; its return value is the child's exit code, 99 if it throws.
/// Returns what waitpid() says.
template <class Action>
int status_in_child(const Action& action) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    int code = 99;
    try {
      code = action();
    } catch (const std::exception&) {
    }
    ::_exit(code);
  }
  int status = -1;
  ::waitpid(pid, &status, 0);
  return status;
}

}  // namespace lacuna
