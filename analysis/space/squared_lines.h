#pragma once

#include <cstdint>
#include <vector>

namespace lacuna {

/// One pass of the exact Euclidean distance over neighbouring lines side by side: each value
/// becomes the least value(j) + (i - j)^2 over all positions j of its line, where positions -1 and
/// n, outside the grid, have value 0.
class SquaredLines {
 public:
  static constexpr int lanes = 16;

  /// Lines of `length` positions.
  explicit SquaredLines(int length);

  /// Values of position i in [0, length), one per line; the caller of a pass fills all lanes.
  std::uint32_t* at(int i) { return &values_[static_cast<std::size_t>(i) * lanes]; }

  /// Processes all lines at once, from each position outwards until no farther position can be
  /// nearer: fast for short distances. The result is in at().
  void search_outwards();
  /// Processes each line by the lower envelope of parabolas (Meijster, Roerdink and Hesselink
  /// 2000), in linear time.
  void lower_envelope();
  /// The faster of the two.
  void run();

 private:
  void lower_envelope(std::size_t lane);

  int length_;
  std::vector<std::uint32_t> values_, result_;
  std::vector<std::int64_t> line_;  // one lane, with the two positions outside
  std::vector<int> vertex_,
      begin_;  // parabolas of the envelope: where its vertex is, and its start
};

}  // namespace lacuna
