#include "jobs/queue/executor_local.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "base/log/log.h"
#include "base/storage/passing_error.h"
#include "jobs/queue/child_process.h"
#include "jobs/queue/oom_kills.h"
#include "jobs/queue/submission.h"
#include "jobs/spec/byte_size.h"
#include "jobs/store/exit_code.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

/// The ending, classified as out_of_memory if memory ran out.
Ending name_memory(Ending end, std::uint64_t limit, bool kernel_killed) {
  if (end.kind == Ending::Kind::exited && end.code == exit_memory) {
    const std::string size = limit > 0 ? fmt::format(" (limit {})", byte_size_text(limit)) : "";
    return {Ending::Kind::out_of_memory, end.code, "renderer ran out of memory" + size};
  }
  if (end.kind == Ending::Kind::killed && end.code == SIGKILL && kernel_killed) {
    return {Ending::Kind::out_of_memory, 128 + SIGKILL,
            "renderer ran out of memory: killed by the kernel"};
  }
  return end;
}

/// A job's log, to append to.
FileHandle open_log(const fs::path& file) {
  FileHandle log(::open(file.c_str(),
                        O_WRONLY | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0644));
  if (!log) throw_file_error(errno, "write", file);
  return log;
}

}  // namespace

StopSignal::StopSignal() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!event_) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void StopSignal::request() const {
  requested_ = true;
  ::eventfd_write(event_.get(), 1);
}

void StopSignal::leave() const {
  leaves_ = true;
  ::eventfd_write(event_.get(), 1);
}

std::vector<std::string> renderer_environment(const ExecutorSettings& settings) {
  std::string roots;
  for (const auto& root : settings.scenes) {
    if (root.string().find(':') != std::string::npos) {
      throw std::invalid_argument(fmt::format(
          "{}: a scenes folder's path must not contain ':', which separates the folders",
          root.string()));
    }
    if (!roots.empty()) roots += ':';
    roots += root.string();
  }
  const fs::path cache = settings.cache.empty() ? settings.data / "cache" : settings.cache;
  return {"LACUNA_DATA=" + settings.data.string(), "LACUNA_CACHE=" + cache.string(),
          "LACUNA_SCENES=" + roots,
          fmt::format("LACUNA_GRACE={}", static_cast<double>(settings.grace.count()) / 1000)};
}

std::vector<std::string> child_environment(const ExecutorSettings& settings) {
  const std::vector<std::string> set = renderer_environment(settings);
  std::vector<std::string> all = set;
  for (const std::string& entry : own_environment()) {
    const std::string name = entry.substr(0, entry.find('=') + 1);
    const auto sets = [&](const std::string& s) { return s.starts_with(name); };
    if (std::ranges::none_of(set, sets)) all.push_back(entry);
  }
  return all;
}

void check_renderer(const ExecutorSettings& settings) {
  if (::access(settings.renderer.c_str(), X_OK) != 0) {
    throw std::invalid_argument(
        fmt::format("{} is not an executable program", settings.renderer.string()));
  }
}

LocalExecutor::LocalExecutor(ExecutorSettings settings) : settings_(std::move(settings)) {
  check_renderer(settings_);
  environment_ = child_environment(settings_);
}

Ending folder_unusable(const JobFolder& folder, const std::system_error& error) {
  const std::string reason = fmt::format("renderer could not be started: {}", error.what());
  if (!may_pass(error) && !is_gone(folder.dir())) return {Ending::Kind::refused, 0, reason};
  return {Ending::Kind::not_started, error.code().value(), reason};
}

Ending LocalExecutor::run(const Task& task, const StopSignal& stop, const Notices& notices) {
  const JobFolder& folder = task.folder;
  FileHandle output;
  try {
    forget_submission(folder);  // from a service that ran its jobs on a cluster
    output = open_log(folder.file("log.txt"));
  } catch (const std::system_error& error) {
    return folder_unusable(folder, error);
  }
  try {
    Command command{.arguments = {settings_.renderer.string(), "render", folder.dir().string()},
                    .environment = environment_,
                    .directory = settings_.directory,
                    .output_fd = output.get(),
                    .limits = settings_.limits};
    command.arguments.insert(command.arguments.end(), settings_.options.begin(),
                             settings_.options.end());
    const std::uint64_t kills_before = oom_kills();
    ChildProcess child(command);
    if (notices.started) notices.started(child.pid());
    bool killed = false;
    if (!child.wait(stop.fd(), std::chrono::milliseconds(-1))) {
      child.signal(SIGTERM);
      if (!child.wait(-1, settings_.grace)) {
        log::warn("{}: its renderer did not stop within {} s of the request and is killed",
                  folder.id(), static_cast<double>(settings_.grace.count()) / 1000);
        child.signal(SIGKILL);
        killed = true;
        child.wait(-1, std::chrono::milliseconds(-1));
      }
    }
    Ending end = name_memory(child.reap(), settings_.limits.memory_bytes,
                             !killed && oom_kills() > kills_before);
    const std::string why = killed ? "" : why_it_cannot_begin(command, end, stop);
    return why.empty() ? end : Ending{Ending::Kind::not_started, ENOEXEC, why};
  } catch (const std::system_error& error) {
    return {Ending::Kind::not_started, error.code().value(),
            fmt::format("renderer could not be started: {}", error.what())};
  }
}

}  // namespace lacuna
