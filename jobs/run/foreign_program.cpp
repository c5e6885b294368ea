#include "jobs/run/foreign_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <system_error>

#include "base/parallel/clock_seconds.h"
#include "base/parallel/stop.h"
#include "base/storage/atomic_file.h"
#include "jobs/queue/child_process.h"
#include "jobs/queue/find_program.h"
#include "renderer/core/scene_error.h"

namespace lacuna {
namespace {

constexpr std::chrono::milliseconds tick{100};

/// The last lines of a program's output, for an error message.
std::string end_of(const std::filesystem::path& log) {
  constexpr std::size_t most = 400, most_read = 64 << 20;
  std::string text;
  try {
    text = read_file(log, most_read);
  } catch (const std::exception&) {
    return {};
  }
  while (text.ends_with('\n')) text.pop_back();
  if (text.size() > most) text = text.substr(text.size() - most);
  return text;
}

}  // namespace

std::string fill_in(std::string_view text, const Placeholders& values) {
  std::string out;
  while (!text.empty()) {
    const std::size_t open = std::min(text.find('{'), text.size());
    out += text.substr(0, open);
    text.remove_prefix(open);
    const std::size_t close = text.find('}');
    const auto value = close == text.npos ? values.end() : values.find(text.substr(1, close - 1));
    if (value != values.end()) {
      out += value->second;
      text.remove_prefix(close + 1);
    } else if (!text.empty()) {
      out += text.front();
      text.remove_prefix(1);
    }
  }
  return out;
}

ProgramTime run_program(const ForeignSettings& settings, const Placeholders& values,
                        const std::filesystem::path& log,
                        const std::function<bool()>& interrupted) {
  const FileHandle output(::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (!output) throw std::system_error(errno, std::generic_category(), log.string());
  Command command{.arguments = {},
                  .environment = own_environment(),
                  .directory = std::filesystem::current_path(),
                  .output_fd = output.get(),
                  .limits = {}};
  for (const std::string& word : settings.command) {
    command.arguments.push_back(fill_in(word, values));
  }
  const std::string name = command.arguments.front();
  command.arguments.front() = find_program(name).string();
  if (command.arguments.front().empty()) {
    throw SceneError(fmt::format("\"command\": there is no program \"{}\" in PATH", name));
  }
  // Processes that the program leaves behind become children, so that their time counts.
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const double began = clock_seconds(CLOCK_MONOTONIC);
  const auto seconds = [&] { return clock_seconds(CLOCK_MONOTONIC) - began; };
  ChildProcess child(command);
  while (!child.wait(-1, tick)) {
    if (interrupted()) throw Stopped{};
    if (seconds() <= settings.timeout) continue;
    throw SceneError(fmt::format("\"{}\" was killed after {:g} s, its \"timeout\"; its output: {}",
                                 name, settings.timeout, end_of(log)));
  }
  const double wall = seconds();
  const Ending end = child.reap();
  if (end.kind != Ending::Kind::exited || end.code != 0) {
    throw SceneError(fmt::format("\"{}\" ended with {} {}; its output: {}", name,
                                 end.kind == Ending::Kind::exited ? "exit code" : "signal",
                                 end.code, end_of(log)));
  }
  return {wall, end.cpu_seconds};
}

}  // namespace lacuna
