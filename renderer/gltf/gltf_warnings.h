#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace lacuna::gltf {

/// Warnings about the parts of a scene that were left out or changed, each message once.
class Warnings {
 public:
  void once(const std::string& message) {
    if (seen_.insert(message).second) messages_.push_back(message);
  }
  /// Keeps the first message of a kind, and counts the others.
  void first_of(const std::string& kind, const std::string& message) {
    if (!seen_.insert(message).second) return;
    const auto [found, is_first] = kinds_.try_emplace(kind, Kind{messages_.size(), 0});
    if (is_first) {
      messages_.push_back(message);
    } else {
      ++found->second.others;
    }
  }
  std::vector<std::string> take() {
    for (const auto& [name, kind] : kinds_) {
      if (kind.others == 0) continue;
      messages_[kind.first] += " (and so for " + std::to_string(kind.others) + " others)";
    }
    return std::move(messages_);
  }

 private:
  struct Kind {
    std::size_t first = 0, others = 0;  ///< the place in messages_; how many others
  };
  std::set<std::string> seen_;
  std::map<std::string, Kind> kinds_;
  std::vector<std::string> messages_;
};

}  // namespace lacuna::gltf
