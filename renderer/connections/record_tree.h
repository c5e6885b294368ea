#pragma once

#include <memory>
#include <span>
#include <vector>

#include "renderer/core/vec.h"

namespace lacuna {

/// Finds points on surfaces that are near one another and face the same way: a k-d tree.
class RecordTree {
 public:
  struct Place {
    V3f x;  ///< scene units
    V3f n;  ///< unit
  };

  RecordTree();
  ~RecordTree();
  RecordTree(RecordTree&&) noexcept;
  RecordTree& operator=(RecordTree&&) noexcept;

  void build(std::vector<Place> places);

  /// Writes into `found` the indices of the nearest places: of twice as many nearest by distance
  /// alone the first by distance times (2 - n . n'). Returns how many, fewer only where there are
  /// fewer places.
  std::size_t nearest(const Place& at, std::span<std::uint32_t> found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lacuna
