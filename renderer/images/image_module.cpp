#include "renderer/images/image_module.h"

#include <dlfcn.h>
#include <sys/mman.h>

#include <cerrno>
#include <filesystem>
#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "renderer/core/clock_seconds.h"

namespace lacuna {
namespace {

constexpr const char* module_name = "lacuna-images.so";

/// Most of the time goes to looking up symbols, and a library that is loaded for the sake of
/// another looks through all 260 for each. Loaded before, these and what they need look among their
/// own: .095 s of CPU in place of .17 s. Each comes after what it needs; it is no error if one
/// lacks.
constexpr const char* loaded_first[] = {"libgdcmMSFF.so.3.0", "libproj.so.25", "libheif.so.1",
                                        "libspatialite.so.7", "libgdal.so.32", "libavformat.so.59",
                                        "libopenvdb.so.10.0"};

/// What the libraries take of the limit of memory, `ulimit -d` (measured: 101 MiB, with the stacks
/// of threads that some of them start). Without it they do not fail but end the process.
constexpr std::size_t needed_room = std::size_t{128} << 20;
/// With less than this the job might take that memory while the module is being loaded.
constexpr std::size_t plenty_of_room = std::size_t{1} << 30;

struct Loaded {
  const ImageCodec* codec = nullptr;  ///< null: `error`
  std::string error;
  bool lacks_memory = false;
  ImageModuleTimes times;
};

/// Installed, beside the program, or for programs that test it in the folder of those that are
/// tested.
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

/// The libraries allocate some 30 MB in small pieces as they start, and glibc asks the system for
/// each single page in a thread other than the first: 8000 calls, .02 s. Room that was there once
/// it finds again.
void make_room_for_small_pieces() {
  constexpr std::size_t piece = 120 * 1024, pieces = 32 * 1024 * 1024 / piece;
  std::vector<std::unique_ptr<char[]>> room;
  room.reserve(pieces);
  for (std::size_t i = 0; i < pieces; ++i) {
    room.push_back(std::make_unique_for_overwrite<char[]>(piece));
  }
}

bool has_room(std::size_t bytes) {
  void* const room = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return false;
  ::munmap(room, bytes);
  return true;
}

void* open_library(const char* file) { return ::dlopen(file, RTLD_LAZY | RTLD_LOCAL); }

void load_codec(Loaded& loaded) {
  const std::filesystem::path file = find_module();
  make_room_for_small_pieces();
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

Loaded load() {
  Loaded loaded;
  loaded.times.begun = clock_seconds(CLOCK_MONOTONIC);
  const double cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  try {
    loaded.lacks_memory = !has_room(needed_room);
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

/// The one load of this process.
struct TheLoad {
  std::mutex mutex;
  std::shared_future<Loaded> result;

  /// `when`: at once on its own thread, or by the first thread that waits; the first call decides.
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

TheLoad& the_load() {
  static TheLoad load;
  return load;
}

const ImageCodec& codec_of(const Loaded& loaded) {
  if (loaded.codec != nullptr) return *loaded.codec;
  if (loaded.lacks_memory) throw std::bad_alloc();
  // No fault of the job: once the module is there, the same job goes on.
  throw std::system_error(ELIBACC, std::generic_category(), loaded.error);
}

}  // namespace

ImageModuleLoading::ImageModuleLoading() {
  if (has_room(plenty_of_room)) {
    the_load().begin(std::launch::async);
  } else {
    the_load().begin(std::launch::deferred).wait();
  }
}
ImageModuleLoading::~ImageModuleLoading() { the_load().begin(std::launch::deferred).wait(); }
void ImageModuleLoading::wait() const { image_codec(); }

const ImageCodec& image_codec() { return codec_of(the_load().begin(std::launch::deferred).get()); }

std::optional<ImageModuleTimes> image_module_times() {
  if (!the_load().begun()) return std::nullopt;
  return the_load().begin(std::launch::deferred).get().times;
}

}  // namespace lacuna
