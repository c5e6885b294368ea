#include "jobs/slurm/run_program.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/storage/file_handle.h"
#include "jobs/queue/child_process.h"
#include "jobs/queue/find_program.h"

namespace lacuna {
namespace {

constexpr std::chrono::seconds patience{60};

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

/// The output of a program in a file, at most 64 MiB.
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

ProgramAnswer run(const std::vector<std::string>& words, const std::filesystem::path& directory) {
  const FileHandle output(::memfd_create("answer", MFD_CLOEXEC));
  if (!output) throw std::system_error(errno, std::generic_category(), "memfd_create");
  Command command{.arguments = words,
                  .environment = slurm_environment(),
                  .directory = directory,
                  .output_fd = output.get(),
                  .limits = {}};
  command.arguments[0] = find_program(words[0]).string();
  if (command.arguments[0].empty()) {
    throw std::system_error(ENOENT, std::generic_category(), words[0]);
  }
  ChildProcess child(command);
  const bool ended = child.wait(-1, patience);
  if (!ended) {
    child.signal(SIGKILL);
    child.wait(-1, std::chrono::milliseconds(-1));
  }
  const Ending end = child.reap();
  const int code = end.kind == Ending::Kind::exited ? end.code : 128 + end.code;
  if (ended) return {code, program_output(output.get())};
  return {code,
          fmt::format("no answer in {} s\n{}", patience.count(), program_output(output.get()))};
}

}  // namespace

void check_slurm_programs(const std::string& option) {
  for (const char* program : {"sbatch", "squeue", "scancel", "scontrol"}) {
    if (find_program(program).empty()) {
      throw std::invalid_argument(
          fmt::format("{} needs Slurm's program {}, which is not in PATH", option, program));
    }
  }
}

RunProgram slurm_runner(std::filesystem::path directory) {
  return [directory = std::move(directory)](const std::vector<std::string>& words) {
    return run(words, directory);
  };
}

}  // namespace lacuna
