#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/storage/bytes.h"

namespace lacuna {

/// What connections gave in the iterations so far, by the cell of space that the eye vertex lies in
/// and by the length of the light path; and what all of a path's connections gave together, by
/// tile. Learned state: the same for any number of threads.
class CellStatistics {
 public:
  /// Light paths are told apart by up to so many vertices; longer ones count as the longest.
  static constexpr int lengths = 8;

  struct Cell {
    std::uint64_t visits = 0;                    ///< eye vertices
    std::array<std::uint64_t, lengths> asked{};  ///< of those, how many could be joined
    std::array<double, lengths> squares{};       ///< sum over `asked` of what arrived, squared
  };

  /// What one tile saw in one iteration: the cells that it met, in the order of meeting.
  class Tally {
   public:
    Tally() = default;
    explicit Tally(std::size_t cells) : place_(cells, none) {}

    void visit(std::uint32_t cell) { ++at(cell).visits; }
    void asked(std::uint32_t cell, int s) { ++at(cell).asked[index(s)]; }
    /// `value`: per unit of the eye vertex' throughput, if the connection had been made for
    /// certain; it was made with probability `survival`.
    void arrived(std::uint32_t cell, int s, double value, double survival) {
      at(cell).squares[index(s)] += value * value / survival;
    }
    /// What the connections of a path gave to its pixel.
    void gathered(double value) { gathered_ += value; }
    void paths(std::uint64_t n) { paths_ += n; }
    /// To be called when the tile is done: leaves what add() reads.
    void close() { place_ = {}; }

   private:
    friend class CellStatistics;
    static constexpr std::uint32_t none = ~0U;

    Cell& at(std::uint32_t cell) {
      std::uint32_t& place = place_[cell];
      if (place == none) {
        place = static_cast<std::uint32_t>(met_.size());
        met_.push_back({cell, {}});
      }
      return met_[place].sums;
    }

    struct Met {
      std::uint32_t cell;
      Cell sums;
    };
    std::vector<std::uint32_t> place_;  // of each cell in met_
    std::vector<Met> met_;
    double gathered_ = 0;
    std::uint64_t paths_ = 0;
  };

  void resize(std::size_t cells) { cells_.assign(cells, {}); }
  std::size_t cells() const { return cells_.size(); }
  std::uint64_t visits(std::uint32_t cell) const { return cells_[cell].visits; }

  /// Probability with which to make a connection of an eye vertex in `cell`, of the given
  /// throughput, with a light path of `s` vertices: the root of the mean square of what such ones
  /// gave, over `enough`, but at least least_survival. 1 if `enough` is 0, or while too few were
  /// asked for.
  float survival(std::uint32_t cell, int s, double throughput, double enough) const {
    if (!(enough > 0) || expected_.empty()) return 1;
    const double expected = expected_[cell * std::size_t{lengths} + index(s)];
    const double p = throughput * expected / enough;
    return p < 1 ? static_cast<float>(std::max(p, least_survival)) : 1.0F;
  }
  /// Mean of what all connections of a path give in tile `i`; 0 while it is not known.
  double mean(std::size_t i) const {
    return i < tiles_.size() && tiles_[i].paths > 0
               ? tiles_[i].gathered / static_cast<double>(tiles_[i].paths)
               : 0;
  }

  /// One iteration's tallies, one for each tile, in the tiles' order.
  void add(std::span<const Tally> tallies);

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error if they are of other cells.
  void load(ByteReader& in);

 private:
  /// What survives counts 1 / survival times: no connection counts more than twentyfold, however
  /// wrong the expectation of its cell is.
  static constexpr double least_survival = 0.05;
  /// The mean square of so many is known to 1 / sqrt(32), a sixth, of the spread of one; before,
  /// all are made.
  static constexpr std::uint64_t least_asked = 32;

  static std::size_t index(int s) { return static_cast<std::size_t>(std::min(s, lengths) - 1); }
  void expect();

  struct TileSums {
    double gathered = 0;
    std::uint64_t paths = 0;
  };
  std::vector<Cell> cells_;
  std::vector<TileSums> tiles_;
  std::vector<double> expected_;  // of each cell and length; infinite: not known yet
};

}  // namespace lacuna
