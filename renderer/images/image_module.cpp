#include "renderer/images/image_module.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "analysis/space/memory_limit.h"
#include "base/parallel/clock_seconds.h"

namespace lacuna {
namespace {

constexpr const char* module_name = "lacuna-images.so";

/// Loading spends most of its time on symbol lookup: a dependency of another library searches all
/// 260 libraries for each symbol. If these are loaded first, they and their dependencies search
/// only their own: .095 s of CPU instead of .17 s. Each follows its dependencies; a missing one is
/// no error.
constexpr const char* loaded_first[] = {"libgdcmMSFF.so.3.0", "libproj.so.25", "libheif.so.1",
                                        "libspatialite.so.7", "libgdal.so.32", "libavformat.so.59",
                                        "libopenvdb.so.10.0"};

/// An upper bound of the libraries' memory: measured are 400 MiB of address space, and a stack for
/// each of five threads.
constexpr std::size_t room_without_stacks = std::size_t{1} << 30;
constexpr std::size_t threads_of_libraries = 8;

/// A child that loads the module (.2 s of CPU) and deadlocks uses no CPU: it is killed after this
/// time without any. The limit of CPU time ends an endless loop.
constexpr double longest_idle_seconds = 2;
constexpr rlim_t most_cpu_seconds = 20;

struct Loaded {
  const ImageCodec* codec = nullptr;  ///< null: see `error`
  std::string error;
  bool lacks_memory = false;
  ImageModuleTimes times;
};

/// Installed, beside the program, or, for tests, in the folder of the tested programs.
std::filesystem::path find_module() {
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::filesystem::path beside = folder / module_name;
  std::filesystem::path near = folder.parent_path() / "bin" / module_name;
  std::filesystem::path installed = folder.parent_path() / "lib/lacuna/modules" / module_name;
  std::error_code error;
  if (std::filesystem::exists(installed, error)) return installed;
  return !std::filesystem::exists(beside, error) && std::filesystem::exists(near, error) ? near
                                                                                         : beside;
}

/// The libraries allocate about 30 MB in small blocks at start-up; outside the main thread glibc
/// requests each page separately: 8000 system calls, .02 s. It reuses memory that was allocated and
/// freed before.
void grow_heap() {
  constexpr std::size_t piece = 120 * 1024, pieces = 32 * 1024 * 1024 / piece;
  std::vector<std::unique_ptr<char[]>> room;
  room.reserve(pieces);
  for (std::size_t i = 0; i < pieces; ++i) {
    room.push_back(std::make_unique_for_overwrite<char[]>(piece));
  }
}

bool is_limited(decltype(RLIMIT_AS) resource) {
  rlimit limit{};
  return ::getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/// Whether the memory of this process is limited (`ulimit -v` or `-d`).
bool memory_is_limited() { return is_limited(RLIMIT_AS) || is_limited(RLIMIT_DATA); }

bool has_room(std::size_t bytes, bool keep) {
  void* const room = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return false;
  if (!keep) ::munmap(room, bytes);
  return true;
}

bool has_plenty_of_room() {
  pthread_attr_t defaults;
  std::size_t stack = 0;
  if (::pthread_getattr_default_np(&defaults) == 0) {
    ::pthread_attr_getstacksize(&defaults, &stack);
    ::pthread_attr_destroy(&defaults);
  }
  return has_room(room_without_stacks + threads_of_libraries * stack, false);
}

void* open_library(const char* file) { return ::dlopen(file, RTLD_LAZY | RTLD_LOCAL); }

void load_codec(Loaded& loaded) {
  const std::filesystem::path file = find_module();
  grow_heap();
  for (const char* library : loaded_first) open_library(library);
  void* const library = open_library(file.c_str());
  void* const function = library == nullptr ? nullptr : ::dlsym(library, image_codec_symbol);
  if (function == nullptr) {
    const std::string reason = ::dlerror();
    loaded.error = file.string() + ": images can be neither read nor written: " + reason;
    loaded.lacks_memory = reason.find("annot allocate memory") != std::string::npos ||
                          reason.find("failed to map segment") != std::string::npos;
    return;
  }
  loaded.codec = reinterpret_cast<ImageCodecFunction>(function)();
}

/// Runs in a child of loads_in_a_child(): exits with 0 if the module can be loaded, 1 if memory is
/// insufficient.
[[noreturn]] void try_to_load() {
  ::prctl(PR_SET_DUMPABLE, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit cpu{most_cpu_seconds, most_cpu_seconds};
  ::setrlimit(RLIMIT_CPU, &cpu);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  // Memory use differs between loads, by the order of the threads.
  constexpr std::size_t margin = std::size_t{16} << 20;
  if (!has_room(margin, true)) ::_exit(1);
  try {
    Loaded loaded;
    load_codec(loaded);
    ::_exit(loaded.lacks_memory ? 1 : 0);  // the parent finds any other error itself
  } catch (...) {
    ::_exit(1);
  }
}

/// Waits until `child` ends, which closes the other end of `pipe`. Returns false if it hangs.
bool wait_for_end(pid_t child, int pipe) {
  clockid_t clock{};
  if (::clock_getcpuclockid(child, &clock) != 0) return false;
  constexpr int step_ms = 100;
  double used = 0, idle_since = clock_seconds(CLOCK_MONOTONIC);
  for (pollfd end{pipe, POLLIN, 0}; ::poll(&end, 1, step_ms) != 1;) {
    const double now = clock_seconds(CLOCK_MONOTONIC);
    if (const double cpu = clock_seconds(clock); cpu != used) {
      used = cpu;
      idle_since = now;
    }
    if (now - idle_since > longest_idle_seconds) return false;
  }
  return true;
}

/// Loads the module in a copy of this process. If memory is insufficient, constructors of the
/// libraries throw uncaught exceptions, or wait for threads that could not start: the process
/// aborts with SIGABRT, or never ends.
bool loads_in_a_child() {
  std::array<int, 2> alive{};  // closed at the other end when the child ends
  if (::pipe2(alive.data(), O_CLOEXEC) != 0) return false;
  const pid_t child = ::fork();
  if (child == 0) try_to_load();
  ::close(alive[1]);
  const bool ended = child > 0 && wait_for_end(child, alive[0]);
  ::close(alive[0]);
  if (child < 0) return false;
  if (!ended) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return ended && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

Loaded load() {
  Loaded loaded;
  loaded.times.begun = clock_seconds(CLOCK_MONOTONIC);
  const double cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  try {
    loaded.lacks_memory = memory_is_limited() && !has_plenty_of_room() && !loads_in_a_child();
    if (!loaded.lacks_memory) load_codec(loaded);
  } catch (const std::bad_alloc&) {
    loaded.lacks_memory = true;
  } catch (const std::exception& e) {
    loaded.error = std::string(module_name) + ": " + e.what();
  }
  loaded.times.seconds = clock_seconds(CLOCK_MONOTONIC) - loaded.times.begun;
  loaded.times.cpu_seconds = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - cpu;
  return loaded;
}

/// The load of this process.
struct ModuleLoad {
  std::mutex mutex;
  std::shared_future<Loaded> result;

  /// `when`: at once on its own thread, or by the first thread that waits. The first call decides.
  std::shared_future<Loaded> begin(std::launch when) {
    const std::lock_guard lock(mutex);
    if (!result.valid()) result = std::async(when, load).share();
    return result;
  }
  bool begun() {
    const std::lock_guard lock(mutex);
    return result.valid();
  }
};

ModuleLoad& module_load() {
  static ModuleLoad load;
  return load;
}

const ImageCodec& codec_of(const Loaded& loaded) {
  if (loaded.codec != nullptr) return *loaded.codec;
  if (loaded.lacks_memory) {
    throw MemoryLimitError(std::string(module_name) +
                           ": the libraries that read and write images exceed the memory limit "
                           "(ulimit -v or -d); they need about 450 MiB of address space");
  }
  // Not the job's fault: the same job can continue once the module is there.
  throw std::system_error(ELIBACC, std::generic_category(), loaded.error);
}

}  // namespace

ImageModuleLoading::ImageModuleLoading() {
  // Otherwise the job might use up the limited memory while the module is being loaded.
  const bool at_once = memory_is_limited();
  const auto loading = module_load().begin(at_once ? std::launch::deferred : std::launch::async);
  if (at_once) loading.wait();
}
ImageModuleLoading::~ImageModuleLoading() { module_load().begin(std::launch::deferred).wait(); }
void ImageModuleLoading::wait() const { image_codec(); }

const ImageCodec& image_codec() {
  return codec_of(module_load().begin(std::launch::deferred).get());
}

std::optional<ImageModuleTimes> image_module_times() {
  if (!module_load().begun()) return std::nullopt;
  return module_load().begin(std::launch::deferred).get().times;
}

}  // namespace lacuna
