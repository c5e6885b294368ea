#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace lacuna {

/// Union-find over indices, with the links wherever the caller has them: `link(i)` is a reference
/// to the index that `i` follows, which is `i` itself at the end of its set. All that follow one
/// another end at the smallest index of their set. Shortens the chain it walks.
template <class Index, class Link>
Index end_of_set(Index i, const Link& link) {
  while (link(i) != i) {
    link(i) = link(link(i));
    i = link(i);
  }
  return i;
}

/// Makes one set of those of `a` and `b`; false if they were one already.
template <class Index, class Link>
bool join_sets(Index a, Index b, const Link& link) {
  a = end_of_set(a, link);
  b = end_of_set(b, link);
  link(std::max(a, b)) = std::min(a, b);
  return a != b;
}

/// The same with links of its own: 0 .. n - 1, each a set at first.
class DisjointSets {
  std::vector<std::uint32_t> links_;
  auto link() {
    return [this](std::uint32_t i) -> std::uint32_t& { return links_[i]; };
  }

 public:
  explicit DisjointSets(std::size_t n) : links_(n) {
    std::iota(links_.begin(), links_.end(), std::uint32_t{0});
  }
  /// One more, which is a set of its own; returns it.
  std::uint32_t add() {
    links_.push_back(static_cast<std::uint32_t>(links_.size()));
    return links_.back();
  }
  std::uint32_t end_of(std::uint32_t i) { return end_of_set(i, link()); }
  bool join(std::uint32_t a, std::uint32_t b) { return join_sets(a, b, link()); }
};

}  // namespace lacuna
