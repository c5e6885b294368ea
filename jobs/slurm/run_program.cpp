#include "jobs/slurm/run_program.h"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

#include "jobs/queue/child_process.h"
#include "jobs/queue/find_program.h"

namespace lacuna {
namespace {

constexpr std::chrono::seconds patience{60};

std::vector<std::string> slurm_environment() {
  std::vector<std::string> result;
  for (std::string& entry : own_environment()) {
    bool keep = !entry.starts_with("SLURM_") || entry.starts_with("SLURM_CONF=");
    for (const std::string_view set : {"SQUEUE_", "SACCT_", "SCANCEL_"}) {
      if (entry.starts_with(set)) keep = false;
    }
    if (keep) result.push_back(std::move(entry));
  }
  return result;
}

ProgramAnswer run(const std::vector<std::string>& words, const std::filesystem::path& directory) {
  Command command{
      .arguments = words, .environment = slurm_environment(), .directory = directory, .limits = {}};
  command.arguments[0] = find_program(words[0]).string();
  if (command.arguments[0].empty()) {
    throw std::system_error(ENOENT, std::generic_category(), words[0]);
  }
  const BoundedRun done = run_bounded(command, -1, patience);
  const int code = done.end.kind == Ending::Kind::exited ? done.end.code : 128 + done.end.code;
  const std::string text = done.output + done.errors;
  if (done.in_time) return {code, text};
  return {code, fmt::format("no answer in {} s\n{}", patience.count(), text)};
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
