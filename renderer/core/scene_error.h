#pragma once

#include <stdexcept>

namespace lacuna {

/// A scene or an asset that cannot be used. The message names the file, the position in it, the
/// value found and the values allowed. `lacuna render` ends with exit code 3.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lacuna
