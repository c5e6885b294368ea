#pragma once

#include <optional>

#include "renderer/images/image_codec.h"

namespace lacuna {

// OpenImageIO depends on 260 shared libraries; loading them costs more time and memory than many
// commands need otherwise. The program therefore does not link it. The module `lacuna-images.so`,
// beside the program or in `../bin`, does, and a process loads the module when it needs the first
// image.

/// Starts loading the module on its own thread, unless it is loaded, and returns at once; if memory
/// is limited, loads the module before it returns. The destructor waits until the module is loaded:
/// a program that exits while libraries are loaded may crash.
class ImageModuleLoading {
 public:
  ImageModuleLoading();
  ImageModuleLoading(const ImageModuleLoading&) = delete;
  ~ImageModuleLoading();

  /// Waits until the module is loaded. Throws like image_codec().
  void wait() const;
};

/// Loads the module, or waits until another thread has loaded it; near a memory limit a child
/// process tries it first. Thread-safe. Throws std::runtime_error with the file's name if it is
/// missing or cannot be loaded, MemoryLimitError if the memory limit is too low.
const ImageCodec& image_codec();

/// When the module was loaded and the time taken.
struct ImageModuleTimes {
  double begun = 0;        ///< start, on the monotonic clock
  double seconds = 0;      ///< of the wall clock
  double cpu_seconds = 0;  ///< of the thread that loaded it
};

/// None if the module has not been needed. Waits while it is being loaded.
std::optional<ImageModuleTimes> image_module_times();

}  // namespace lacuna
