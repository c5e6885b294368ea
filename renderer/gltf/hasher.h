#pragma once

#include <xxhash.h>

#include <cstdint>
#include <memory>
#include <span>

namespace lacuna {

/// XXH3-64 of a sequence of arrays; the length of each counts, so that moving an element from one
/// array to the next changes the hash.
class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), &XXH3_freeState) { XXH3_64bits_reset(state_.get()); }

  template <class T>
  void add(std::span<const T> values) {
    const std::uint64_t size = values.size();
    XXH3_64bits_update(state_.get(), &size, sizeof size);
    XXH3_64bits_update(state_.get(), values.data(), values.size_bytes());
  }
  std::uint64_t digest() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

}  // namespace lacuna
