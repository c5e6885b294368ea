#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace lacuna {

/// Union-find over indices with the parent links stored by the caller: `link(i)` is a reference to
/// the parent of `i`, which is `i` itself at the root. Returns the root of the set of `i`, its
/// smallest index. Halves the path.
template <class Index, class Link>
Index end_of_set(Index i, const Link& link) {
  while (link(i) != i) {
    link(i) = link(link(i));
    i = link(i);
  }
  return i;
}

/// Merges the sets of `a` and `b`; false if they were the same set.
template <class Index, class Link>
bool join_sets(Index a, Index b, const Link& link) {
  a = end_of_set(a, link);
  b = end_of_set(b, link);
  link(std::max(a, b)) = std::min(a, b);
  return a != b;
}

/// Union-find with its own links: 0 .. n - 1, each a set at first.
class DisjointSets {
  std::vector<std::uint32_t> links_;
  auto link() {
    return [this](std::uint32_t i) -> std::uint32_t& { return links_[i]; };
  }

 public:
  explicit DisjointSets(std::size_t n) : links_(n) {
    std::iota(links_.begin(), links_.end(), std::uint32_t{0});
  }
  /// Adds an index as a set of its own, and returns it.
  std::uint32_t add() {
    links_.push_back(static_cast<std::uint32_t>(links_.size()));
    return links_.back();
  }
  std::uint32_t end_of(std::uint32_t i) { return end_of_set(i, link()); }
  bool join(std::uint32_t a, std::uint32_t b) { return join_sets(a, b, link()); }
};

}  // namespace lacuna
