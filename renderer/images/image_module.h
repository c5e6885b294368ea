#pragma once

#include <optional>

#include "renderer/images/image_codec.h"

namespace lacuna {

// OpenImageIO depends on 260 shared libraries, which cost more time and memory than many commands
// do otherwise. The program therefore does not link it: the module `lacuna-images.so`, beside the
// program or in `../bin`, does, and a process loads it when it needs the first image.

/// Starts loading the module on a thread of its own, unless it is loaded already, and returns at
/// once; where memory is limited it loads the module before it returns. The destructor waits until
/// the module is loaded: a program that exits during the loading of libraries may crash.
class ImageModuleLoading {
 public:
  ImageModuleLoading();
  ImageModuleLoading(const ImageModuleLoading&) = delete;
  ~ImageModuleLoading();

  /// Waits until the module is loaded. Throws like image_codec().
  void wait() const;
};

/// Loads the module, or waits until another thread has loaded it; near a limit of memory a child
/// process tries it first. Thread-safe. Throws std::runtime_error with the file's name if it is
/// missing or cannot be loaded, MemoryLimitError if the limit is too low.
const ImageCodec& image_codec();

/// When the module was loaded and what that took.
struct ImageModuleTimes {
  double begun = 0;        ///< on the monotonic clock
  double seconds = 0;      ///< of the wall clock
  double cpu_seconds = 0;  ///< of the thread that loaded it
};

/// None if the module was not needed so far. Waits while it is being loaded.
std::optional<ImageModuleTimes> image_module_times();

}  // namespace lacuna
