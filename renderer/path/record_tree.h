#pragma once

#include <memory>
#include <span>
#include <vector>

#include "renderer/path/vertex.h"

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

  /// How far apart two places count: their distance times (2 - n . n'), scene units.
  static float rank(const Place& a, const Place& b) {
    return std::sqrt((a.x - b.x).length2()) * (2 - dot(a.n, b.n));
  }

  /// Writes into `found` the indices of the nearest places: of twice as many nearest by distance
  /// alone the first by rank(). Returns how many, fewer only where there are fewer places.
  std::size_t nearest(const Place& at, std::span<std::uint32_t> found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Where a surface that an eye path met is: the normal on the side it is seen from.
inline RecordTree::Place place_of(const Vertex& v) { return {v.surface.x, v.side()}; }

}  // namespace lacuna
