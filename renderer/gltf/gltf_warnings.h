#pragma once

#include <set>
#include <string>
#include <vector>

#include "renderer/geometry/scene_data.h"

namespace lacuna::gltf {

/// Warnings about parts of a scene that were left out, each message once.
class Warnings {
 public:
  void once(const std::string& message) {
    if (seen_.insert(message).second) messages_.push_back(message);
  }
  std::vector<std::string> take() { return std::move(messages_); }

 private:
  std::set<std::string> seen_;
  std::vector<std::string> messages_;
};

}  // namespace lacuna::gltf
