#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/storage/bytes.h"

namespace lacuna {

/// The second moment of the contributions of connections in all iterations so far, by the cell of
/// the eye vertex and the length of the light path; and the mean contribution of all connections of
/// a path, by tile. Learned state, independent of the number of threads.
class CellStatistics {
 public:
  /// Number of light path lengths, in vertices, with separate statistics; longer paths share the
  /// last.
  static constexpr int lengths = 8;

  struct Cell {
    std::uint64_t visits = 0;  ///< number of eye vertices
    std::array<std::uint64_t, lengths>
        attempts{};                         ///< eye vertices with light paths of this length
    std::array<double, lengths> squares{};  ///< sum over `attempts` of the squared contributions
  };

  /// The statistics of one tile in one iteration: the visited cells, in the order of first visits.
  class Accumulator {
   public:
    Accumulator() = default;
    explicit Accumulator(std::size_t cells) : slot_(cells, none) {}

    void visit(std::uint32_t cell) { ++at(cell).visits; }
    void attempt(std::uint32_t cell, int s) { ++at(cell).attempts[index(s)]; }
    /// Adds the contribution of a connection. `value` is per unit of the eye vertex' throughput,
    /// and not divided by `survival`, the probability of making the connection.
    void add_contribution(std::uint32_t cell, int s, double value, double survival) {
      at(cell).squares[index(s)] += value * value / survival;
    }
    /// Adds the sum of the contributions of a path's connections to its pixel.
    void add_path_sum(double value) { gathered_ += value; }
    void add_paths(std::uint64_t n) { paths_ += n; }
    /// Call at the end of the tile: frees memory that CellStatistics::add() does not read.
    void close() { slot_ = {}; }

   private:
    friend class CellStatistics;
    static constexpr std::uint32_t none = ~0U;

    Cell& at(std::uint32_t cell) {
      std::uint32_t& slot = slot_[cell];
      if (slot == none) {
        slot = static_cast<std::uint32_t>(visited_.size());
        visited_.push_back({cell, {}});
      }
      return visited_[slot].sums;
    }

    struct Visited {
      std::uint32_t cell;
      Cell sums;
    };
    std::vector<std::uint32_t> slot_;  // of each cell: index in visited_
    std::vector<Visited> visited_;
    double gathered_ = 0;
    std::uint64_t paths_ = 0;
  };

  void resize(std::size_t cells) { cells_.assign(cells, {}); }
  std::size_t cells() const { return cells_.size(); }
  std::uint64_t visits(std::uint32_t cell) const { return cells_[cell].visits; }

  /// Probability of making a connection between an eye vertex in `cell`, of the given throughput,
  /// and a light path of `s` vertices: throughput sqrt(E[contribution^2]) / threshold, clamped to
  /// [min_survival, 1]. 1 if `threshold` is 0, or with fewer than min_attempts attempts.
  float survival(std::uint32_t cell, int s, double throughput, double threshold) const {
    if (!(threshold > 0) || expected_.empty()) return 1;
    const double expected = expected_[cell * std::size_t{lengths} + index(s)];
    const double p = throughput * expected / threshold;
    return p < 1 ? static_cast<float>(std::max(p, min_survival)) : 1.0F;
  }
  /// Mean contribution of all connections of a path in tile `i`; 0 before the first iteration.
  double mean(std::size_t i) const {
    return i < tiles_.size() && tiles_[i].paths > 0
               ? tiles_[i].gathered / static_cast<double>(tiles_[i].paths)
               : 0;
  }

  /// Adds one iteration's accumulators, one per tile, in the tiles' order.
  void add(std::span<const Accumulator> accumulators);

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error if the saved number of cells differs.
  void load(ByteReader& in);

 private:
  /// Limits the weight of a connection kept by roulette to 20, however wrong the expectation of its
  /// cell.
  static constexpr double min_survival = 0.05;
  /// Attempts from which a mean square is used: its standard error is then 1 / sqrt(32), about a
  /// sixth, of the standard deviation. Before, all connections are made.
  static constexpr std::uint64_t min_attempts = 32;

  static std::size_t index(int s) { return static_cast<std::size_t>(std::min(s, lengths) - 1); }
  void update_expected();

  struct TileSums {
    double gathered = 0;
    std::uint64_t paths = 0;
  };
  std::vector<Cell> cells_;
  std::vector<TileSums> tiles_;
  std::vector<double> expected_;  // sqrt(mean square) by cell and length; infinite: unknown
};

}  // namespace lacuna
