#pragma once

#include <stdexcept>

namespace lacuna {

/// The scene or an asset is invalid. The message names the file, the position in it, the value
/// found and the allowed values. `lacuna render` ends with exit code 3.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lacuna
