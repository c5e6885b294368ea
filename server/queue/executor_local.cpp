#include "server/queue/executor_local.h"

#include <fmt/format.h>
#include <sys/eventfd.h>

#include <csignal>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "jobs/spec/byte_size.h"
#include "jobs/store/exit_code.h"
#include "server/queue/child_process.h"
#include "server/queue/oom_kills.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

/// The ending, classified as out of memory where memory ran out.
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

/// The service's own environment, with the folders of its command line.
std::vector<std::string> child_environment(const ExecutorSettings& settings) {
  const std::string data = "LACUNA_DATA=", cache = "LACUNA_CACHE=", scenes = "LACUNA_SCENES=";
  std::vector<std::string> result;
  for (char** p = ::environ; *p != nullptr; ++p) {
    const std::string_view entry = *p;
    const bool own =
        entry.starts_with(data) || entry.starts_with(cache) || entry.starts_with(scenes);
    if (!own) result.emplace_back(entry);
  }
  std::string roots;
  for (const auto& root : settings.scenes) {
    if (!roots.empty()) roots += ':';
    roots += root.string();
  }
  result.push_back(data + settings.data.string());
  if (!settings.cache.empty()) result.push_back(cache + settings.cache.string());
  result.push_back(scenes + roots);
  return result;
}

}  // namespace

StopSignal::StopSignal() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!event_) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void StopSignal::request() const { ::eventfd_write(event_.get(), 1); }

LocalExecutor::LocalExecutor(ExecutorSettings settings) : settings_(std::move(settings)) {
  if (::access(settings_.renderer.c_str(), X_OK) != 0) {
    throw std::invalid_argument(
        fmt::format("{} is not a program that can be started", settings_.renderer.string()));
  }
  for (const auto& root : settings_.scenes) {
    if (root.string().find(':') != std::string::npos) {
      throw std::invalid_argument(
          fmt::format("{}: a scenes folder's path may not hold ':', which separates the folders",
                      root.string()));
    }
  }
  environment_ = child_environment(settings_);
}

Ending LocalExecutor::run(const JobFolder& folder, const StopSignal& stop, const Started& started) {
  try {
    const std::uint64_t kills_before = oom_kills();
    ChildProcess child({.arguments = {settings_.renderer.string(), "render", folder.dir().string()},
                        .environment = environment_,
                        .directory = settings_.data,
                        .output = folder.file("log.txt"),
                        .limits = settings_.limits});
    if (started) started(child.pid());
    bool killed = false;
    if (!child.wait(stop.fd(), std::chrono::milliseconds(-1))) {
      child.signal(SIGTERM);
      if (!child.wait(-1, settings_.grace)) {
        log::warn("{}: its renderer did not end within {} s of being asked and is killed",
                  folder.id(), static_cast<double>(settings_.grace.count()) / 1000);
        child.signal(SIGKILL);
        killed = true;
        child.wait(-1, std::chrono::milliseconds(-1));
      }
    }
    return name_memory(child.reap(), settings_.limits.memory_bytes,
                       !killed && oom_kills() > kills_before);
  } catch (const std::system_error& error) {
    return {Ending::Kind::not_started, error.code().value(),
            fmt::format("renderer could not be started: {}", error.what())};
  }
}

}  // namespace lacuna
