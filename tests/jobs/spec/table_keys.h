#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/settings/field.h"

namespace lacuna {

/// A visitor that notes the keys of a table.
struct KeyVisitor {
  std::vector<std::string> keys;
  template <class T>
  void operator()(std::string_view name, T&, const Field&) {
    keys.emplace_back(name);
  }
};

/// The keys of a described struct, in the order of its table.
template <class T>
std::vector<std::string> keys_of(T settings) {
  KeyVisitor visitor;
  describe(visitor, settings);
  return visitor.keys;
}

}  // namespace lacuna
