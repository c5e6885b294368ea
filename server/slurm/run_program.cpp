#include "server/slurm/run_program.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>

#include "base/storage/file_handle.h"
#include "jobs/slurm/run_program.h"
#include "server/queue/child_process.h"

namespace lacuna {
namespace {

constexpr std::chrono::seconds patience{60};

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

RunProgram slurm_runner(std::filesystem::path directory) {
  return [directory = std::move(directory)](const std::vector<std::string>& words) {
    return run(words, directory);
  };
}

}  // namespace lacuna
