#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "analysis/storage/bytes.h"
#include "renderer/path/vertex.h"

namespace lacuna {

/// An estimate of the indirect radiance that a vertex reflects: the luminance that a path gathers
/// behind the vertex over the luminance of its throughput there. Emission and next event estimation
/// at the vertex itself are not included. Roulette and splitting of guided paths use it as the
/// adjoint (Vorba and Krivanek 2016, "Adjoint-driven Russian roulette and splitting").
///
/// A grid of 32^3 cells over the scene, each with six sides for the normals, and coarser grids of
/// 16^3 to 1 cells: a look-up returns the mean of the finest cell with enough samples. It learns
/// from all vertices in rounds of 1, 2, 4, ... iterations; each round replaces the one before,
/// because the first paths have the heaviest tails. The picture's mean does not depend on its
/// values.
class ReflectedRadiance {
 public:
  /// The samples of a cell.
  struct Samples {
    double sum = 0, samples = 0;
  };
  /// The samples of one part of an iteration, by cell of the finest grid.
  class Accumulator {
   public:
    void add(std::uint32_t cell, double value) {
      Samples& c = cells_[cell];
      c.sum += value;
      c.samples += 1;
    }

   private:
    friend class ReflectedRadiance;
    std::unordered_map<std::uint32_t, Samples> cells_;
  };

  ReflectedRadiance() = default;
  /// Over the box of a scene, low corner and size, in scene units.
  ReflectedRadiance(const V3d& low, const V3d& size);

  /// Mean at `v`, a surface; below 0 while nothing is known.
  float at(const Vertex& v) const;
  bool learns() const { return samples_ < enough_samples || round_ < least_rounds; }
  /// One path's value at `v`; only while it learns().
  void record(const Vertex& v, double value, Accumulator& accumulator) const;
  /// Adds the samples of the parts of an iteration, in their order.
  void update(std::span<const Accumulator* const> accumulators);

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error for the state of another scene.
  void load(ByteReader& in);

 private:
  static constexpr int side = 32, sides = 6;
  static constexpr std::size_t levels = 6;  // 32, 16, ..., 1 cells along a side
  /// Samples below which a look-up uses the coarser cell.
  static constexpr double least_samples = 128;
  /// Samples of a round after which learning ends.
  static constexpr double enough_samples = 1 << 18;
  static constexpr std::uint64_t least_rounds = 3;

  struct Cell {
    std::array<std::uint32_t, 3> at;
    std::uint32_t normal;
  };
  std::array<double, 4> grid() const { return {low_.x, low_.y, low_.z, scale_}; }
  Cell cell(const Vertex& v) const;
  static std::size_t index(const Cell& c, std::size_t level);
  void make_means();

  V3d low_{0.0};
  double scale_ = 0;
  struct Saved {
    Samples met;
    std::uint64_t cell;
  };
  std::uint64_t round_ = 0, iteration_ = 0;  // iterations done of 2^round_
  double samples_ = 0;                       // in known_
  std::vector<Samples> known_, learning_;    // of the finest grid: the last round's, and this one's
  float mean_ = 0;                           // of all samples in known_
  /// Of each grid: the means, below 0 where too few samples were met.
  std::array<std::vector<float>, levels> means_;
};

}  // namespace lacuna
