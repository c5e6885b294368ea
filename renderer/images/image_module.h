#pragma once

#include <optional>

#include "renderer/images/image_codec.h"

namespace lacuna {

// OpenImageIO needs 260 shared libraries, which take more time and memory than many a command. So
// it is no part of the program but a module, `lacuna-images.so`, which is loaded once in a process,
// when the first image is needed and never before. It lies beside the program, or in `../bin`.

/// Begins to load the module on a thread of its own, unless that was done already, and returns at
/// once; where a limit of memory is near, it returns when all is done. A program that ends while
/// libraries are being loaded may crash: the destructor waits.
class ImageModuleLoading {
 public:
  ImageModuleLoading();
  ImageModuleLoading(const ImageModuleLoading&) = delete;
  ~ImageModuleLoading();

  /// Waits until the module is loaded. Throws like image_codec().
  void wait() const;
};

/// Loads the module, or waits until another thread has loaded it. Thread-safe. Throws
/// std::runtime_error with the file's name if it is missing or cannot be loaded, std::bad_alloc.
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
