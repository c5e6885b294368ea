#pragma once

#include <stdexcept>

namespace lacuna {

/// A scene or an asset that cannot be used: the message names the file, the place in it, the value
/// found and what is allowed. `lacuna render` ends with exit code 3.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace lacuna
