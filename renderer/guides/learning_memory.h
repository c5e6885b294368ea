#pragma once

#include <atomic>
#include <cstddef>

#include "renderer/core/free_memory.h"

namespace lacuna {

/// Memory of a hash map, bytes: of its elements with a link, the header of an allocation and a
/// bucket each.
template <class Map>
double map_bytes(const Map& map) {
  return double(map.size() * (sizeof(typename Map::value_type) + 4 * sizeof(void*)));
}

/// The memory of what a guide learns from: each part of an iteration keeps its samples until
/// update(), which adds them in the order of the parts.
class LearningMemory {
 public:
  explicit LearningMemory(std::size_t parts) : parts_(double(parts)) {}

  /// A part has finished, whose samples take so many bytes. Throws MemoryLimitError where the parts
  /// so far let expect more than is free for the others. Called by several threads.
  void add(double bytes) {
    constexpr double enough_parts = 16;  // to expect something of the others
    const double sum = bytes_ += static_cast<std::uint64_t>(bytes);
    const double done = double(++done_), left = parts_ - done;
    if (done < enough_parts || sum == 0) return;
    require_free(sum / done * left, [&] {
      return fmt::format(
          "a guide keeps {:.1f} MiB of samples until the end of an iteration (a lower resolution "
          "or "
          "max_depth, or the guide \"bsdf\", needs less); those to come",
          sum / done * parts_ / 0x1p20);
    });
  }

 private:
  double parts_;
  std::atomic<std::uint64_t> bytes_ = 0, done_ = 0;
};

}  // namespace lacuna
