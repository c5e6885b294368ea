#include "jobs/queue/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <system_error>

namespace lacuna {
namespace {

constexpr const char* oom_score_file = "/proc/self/oom_score_adj";

std::vector<char*> c_strings(const std::vector<std::string>& strings) {
  std::vector<char*> result;
  result.reserve(strings.size() + 1);
  for (const std::string& s : strings) result.push_back(const_cast<char*>(s.c_str()));
  result.push_back(nullptr);
  return result;
}

[[noreturn]] void fail(int error, const std::string& what) {
  throw std::system_error(error, std::generic_category(), what);
}

/// Everything that the child needs, prepared before the fork: after it only system calls are safe.
struct Prepared {
  char* const* arguments;
  char* const* environment;
  const char* directory;
  int input, output, errors, report;
  pid_t parent;
  std::uint64_t memory_bytes, file_bytes;
  int niceness;               // absolute
  const char* oom_score_adj;  // as text; empty: unchanged
  std::size_t oom_score_adj_length;
};

/// The limits in the form that the child sets them in.
struct AbsoluteLimits {
  explicit AbsoluteLimits(const ChildLimits& limits)
      : niceness(std::min(19, ::getpriority(PRIO_PROCESS, 0) + limits.niceness)) {
    int own = 0;
    std::ifstream file(oom_score_file);
    if (limits.oom_score_adj > 0 && file >> own) {
      oom_score_adj = std::to_string(std::min(1000, own + limits.oom_score_adj));
    }
  }
  int niceness;
  std::string oom_score_adj;
};

[[noreturn]] void become(const Prepared& p) {
  const auto check = [&](long result) {
    if (result >= 0) return;
    const int error = errno;
    [[maybe_unused]] const ssize_t written = ::write(p.report, &error, sizeof error);
    ::_exit(127);
  };
  check(::setpgid(0, 0));
  check(::prctl(PR_SET_PDEATHSIG, SIGTERM));
  const auto limit = [&](__rlimit_resource resource, std::uint64_t bytes) {
    const rlimit both{bytes, bytes};
    if (bytes > 0) check(::setrlimit(resource, &both));
  };
  limit(RLIMIT_DATA, p.memory_bytes);
  limit(RLIMIT_FSIZE, p.file_bytes);
  check(::setpriority(PRIO_PROCESS, 0, p.niceness));
  if (p.oom_score_adj_length > 0) {
    const int file = ::open(oom_score_file, O_WRONLY | O_CLOEXEC);
    check(file);
    check(::write(file, p.oom_score_adj, p.oom_score_adj_length));
    ::close(file);
  }
  if (::getppid() != p.parent) ::_exit(127);  // the service died before the line above
  for (const int s : {SIGTERM, SIGINT, SIGPIPE, SIGHUP, SIGXFSZ}) ::signal(s, SIG_DFL);
  check(::dup2(p.input, STDIN_FILENO));
  check(::dup2(p.output, STDOUT_FILENO));
  check(::dup2(p.errors, STDERR_FILENO));
  check(::syscall(SYS_close_range, 3U, ~0U, CLOSE_RANGE_CLOEXEC));
  check(::chdir(p.directory));
  sigset_t none;
  ::sigemptyset(&none);
  check(::sigprocmask(SIG_SETMASK, &none, nullptr));
  ::execve(p.arguments[0], p.arguments, p.environment);
  check(-1);
  ::_exit(127);
}

double seconds_of(const rusage& used) {
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

}  // namespace

std::mutex& fork_mutex() {
  static std::mutex mutex;
  return mutex;
}

ChildProcess::ChildProcess(const Command& command) {
  const FileHandle nothing(::open("/dev/null", O_RDWR | O_CLOEXEC));
  const FileHandle output(
      ::fcntl(command.output_fd >= 0 ? command.output_fd : nothing.get(), F_DUPFD_CLOEXEC, 3));
  const FileHandle errors(
      ::fcntl(command.error_fd >= 0 ? command.error_fd : output.get(), F_DUPFD_CLOEXEC, 3));
  if (!nothing || !output || !errors) fail(errno, "a child's output");
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail(errno, "pipe");
  const FileHandle report(ends[0]);
  FileHandle child_report(ends[1]);

  const auto arguments = c_strings(command.arguments);
  const auto environment = c_strings(command.environment);
  const AbsoluteLimits absolute(command.limits);
  const Prepared prepared{arguments.data(),
                          environment.data(),
                          command.directory.c_str(),
                          nothing.get(),
                          output.get(),
                          errors.get(),
                          child_report.get(),
                          ::getpid(),
                          command.limits.memory_bytes,
                          command.limits.file_bytes,
                          absolute.niceness,
                          absolute.oom_score_adj.c_str(),
                          absolute.oom_score_adj.size()};
  const std::lock_guard no_locks(fork_mutex());
  pid_ = ::fork();
  if (pid_ < 0) fail(errno, "fork");
  if (pid_ == 0) become(prepared);
  child_report.close();
  // A successful exec closes it; otherwise it delivers the errno.
  int error = 0;
  const ssize_t n = ::read(report.get(), &error, sizeof error);
  process_ = FileHandle(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
  if (n == sizeof error || !process_) {
    if (n != sizeof error) error = errno;
    ::kill(-pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    fail(error, command.arguments.front());
  }
}

ChildProcess::~ChildProcess() {
  if (pid_ < 0) return;
  signal(SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

bool ChildProcess::wait(int also, std::chrono::milliseconds time) const {
  std::array<pollfd, 2> fds{{{process_.get(), POLLIN, 0}, {also, POLLIN, 0}}};
  const int limit = time.count() < 0 ? -1 : static_cast<int>(time.count());
  while (::poll(fds.data(), fds.size(), limit) < 0 && errno == EINTR) {
  }
  return fds[0].revents != 0;
}

void ChildProcess::signal(int number) const { ::kill(-pid_, number); }

Ending ChildProcess::reap() {
  signal(SIGKILL);  // the leader is dead but still holds the group's number
  int status = 0;
  rusage used{};
  ::wait4(pid_, &status, 0, &used);
  double cpu_seconds = seconds_of(used);
  // Orphans of the group, if this process adopts them (PR_SET_CHILD_SUBREAPER).
  while (::wait4(-pid_, nullptr, 0, &used) > 0) cpu_seconds += seconds_of(used);
  pid_ = -1;
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    return {Ending::Kind::killed, number,
            fmt::format("renderer ended by signal {} ({})", number, ::strsignal(number)),
            cpu_seconds};
  }
  const int code = WEXITSTATUS(status);
  return {Ending::Kind::exited, code, fmt::format("renderer ended with exit code {}", code),
          cpu_seconds};
}

BoundedRun run_bounded(Command command, int stop, std::chrono::milliseconds time) {
  const auto in_memory = [] {
    FileHandle file(::memfd_create("output", MFD_CLOEXEC));
    if (!file) fail(errno, "memfd_create");
    return file;
  };
  const auto content = [](const FileHandle& file) {
    const off_t size = ::lseek(file.get(), 0, SEEK_END);
    std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, 64 << 20)), '\0');
    const ssize_t n = ::pread(file.get(), text.data(), text.size(), 0);
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, n)));
    return text;
  };
  const FileHandle output = in_memory(), errors = in_memory();
  command.output_fd = output.get();
  command.error_fd = errors.get();
  ChildProcess child(command);
  const bool in_time = child.wait(stop, time);
  if (!in_time) {
    child.signal(SIGKILL);
    child.wait(-1, std::chrono::milliseconds(-1));
  }
  Ending end = child.reap();
  return {std::move(end), in_time, content(output), content(errors)};
}

std::vector<std::string> own_environment() {
  std::vector<std::string> all;
  for (char** p = ::environ; *p != nullptr; ++p) all.emplace_back(*p);
  return all;
}

std::string why_it_cannot_begin(Command command, const Ending& end, const StopSignal& stop) {
  constexpr std::chrono::seconds longest{10};  // for --version
  if (end.kind != Ending::Kind::killed || end.code == SIGXFSZ || stop.is_requested()) return {};
  command.arguments = {command.arguments.front(), "--version"};
  command.output_fd = command.error_fd = -1;
  ChildProcess child(command);
  if (!child.wait(stop.fd(), longest)) return {};
  const Ending trial = child.reap();
  if (trial.kind != Ending::Kind::killed && !never_began(trial)) return {};
  return fmt::format("{} --version: {}", command.arguments.front(), trial.reason);
}

}  // namespace lacuna
