#include "jobs/slurm/run_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>

#include "base/storage/file_handle.h"

namespace lacuna {
namespace {

constexpr std::chrono::seconds patience{60};

/// Pointers to texts, and the null pointer that ends them.
std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  result.reserve(texts.size() + 1);
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

::pid_t spawn(std::vector<std::string> words, int output) {
  const std::filesystem::path program = find_program(words[0]);
  if (program.empty()) throw std::system_error(ENOENT, std::generic_category(), words[0]);
  std::vector<std::string> environment = slurm_environment();
  ::posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO}) {
    ::posix_spawn_file_actions_adddup2(&actions, output, fd);
  }
  ::pid_t child = -1;
  const int error = ::posix_spawn(&child, program.c_str(), &actions, nullptr,
                                  pointers(words).data(), pointers(environment).data());
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw std::system_error(error, std::generic_category(), program.string());
  return child;
}

/// Its wait status; nothing: it has not ended in `time`.
std::optional<int> wait_for(::pid_t child, std::chrono::milliseconds time) {
  constexpr std::chrono::milliseconds look{5};
  const auto end = std::chrono::steady_clock::now() + time;
  do {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == child) return status;
    std::this_thread::sleep_for(look);
  } while (std::chrono::steady_clock::now() < end);
  return std::nullopt;
}

ProgramAnswer run(const std::vector<std::string>& words) {
  const FileHandle output(::memfd_create("answer", MFD_CLOEXEC));
  if (!output) throw std::system_error(errno, std::generic_category(), "memfd_create");
  const ::pid_t child = spawn(words, output.get());
  if (const auto status = wait_for(child, patience)) {
    const int code = WIFEXITED(*status) ? WEXITSTATUS(*status) : 128 + WTERMSIG(*status);
    return {code, program_output(output.get())};
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  return {128 + SIGKILL,
          fmt::format("no answer in {} s\n{}", patience.count(), program_output(output.get()))};
}

}  // namespace

std::filesystem::path find_program(const std::string& name) {
  const char* set = std::getenv("PATH");
  std::string_view path = set == nullptr ? "" : set;
  while (!path.empty()) {
    const auto end = std::min(path.find(':'), path.size());
    const std::filesystem::path file = std::filesystem::path(path.substr(0, end)) / name;
    if (file.is_absolute() && ::access(file.c_str(), X_OK) == 0) return file;
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return {};
}

std::vector<std::string> slurm_environment() {
  std::vector<std::string> result;
  for (char** p = ::environ; *p != nullptr; ++p) {
    const std::string_view entry = *p;
    bool keep = !entry.starts_with("SLURM_") || entry.starts_with("SLURM_CONF=");
    for (const std::string_view set : {"SQUEUE_", "SACCT_", "SCANCEL_"}) {
      if (entry.starts_with(set)) keep = false;
    }
    if (keep) result.emplace_back(entry);
  }
  return result;
}

std::string program_output(int file) {
  constexpr std::size_t at_once = 1 << 16, longest = 64 << 20;
  std::string text;
  for (;;) {
    const std::size_t before = text.size();
    text.resize(before + at_once);
    const ::ssize_t n = ::pread(file, text.data() + before, at_once, static_cast<::off_t>(before));
    text.resize(before + static_cast<std::size_t>(n > 0 ? n : 0));
    if (n <= 0 || text.size() >= longest) return text;
  }
}

void check_slurm_programs(const std::string& option) {
  for (const char* program : {"sbatch", "squeue", "scancel", "scontrol"}) {
    if (find_program(program).empty()) {
      throw std::invalid_argument(
          fmt::format("{} needs Slurm's program {}, which is not in PATH", option, program));
    }
  }
}

RunProgram spawning_runner() { return run; }

}  // namespace lacuna
