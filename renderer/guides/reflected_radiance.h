#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/guides/learning_memory.h"
#include "renderer/guides/learning_rounds.h"
#include "renderer/path/vertex.h"

namespace lacuna {

/// An estimate of the indirect radiance that a vertex reflects: the luminance that a path gathers
/// behind the vertex over the luminance of its throughput there. Emission and next event estimation
/// at the vertex itself are not included. Roulette and splitting of guided paths use it as the
/// adjoint (Vorba and Krivanek 2016, "Adjoint-driven Russian roulette and splitting").
///
/// A grid of 32^3 cells over the scene, each with six sides for the normals, and coarser grids of
/// 16^3 to 1 cells: a look-up returns the moments of the finest cell with enough samples. Vertices
/// may be of several classes, which share no cell. It learns from all vertices in
/// LearningRounds; each round replaces the one before, because the first paths have the heaviest
/// tails. The picture's mean does not depend on its values.
class ReflectedRadiance {
 public:
  /// What one path gathered behind a vertex, and the rays that it took.
  struct Sample {
    double value, rays = 0;
  };
  /// The samples of a cell.
  struct Samples {
    double sum = 0, squares = 0, rays = 0, samples = 0;
    static Samples of(const Sample& s) { return {s.value, s.value * s.value, s.rays, 1}; }
    void operator+=(const Samples& o) {
      sum += o.sum;
      squares += o.squares;
      rays += o.rays;
      samples += o.samples;
    }
  };
  /// Of one sample of a cell.
  struct Moments {
    float mean = -1;  ///< below 0 while nothing is known
    float square = 0, rays = 0;
  };
  /// The samples of one part of an iteration, by cell of the finest grid.
  class Accumulator {
   public:
    void add(std::uint32_t cell, const Sample& s) { cells_[cell] += Samples::of(s); }
    double bytes() const { return map_bytes(cells_); }

   private:
    friend class ReflectedRadiance;
    std::unordered_map<std::uint32_t, Samples> cells_;
  };

  ReflectedRadiance() = default;
  /// Over the box of a scene, low corner and size, in scene units. Learning ends after a round of
  /// `enough_samples`.
  ReflectedRadiance(const V3d& low, const V3d& size, std::uint32_t classes = 1,
                    double enough_samples = 1 << 18);

  /// Mean at `v`, a surface; below 0 while nothing is known.
  float at(const Vertex& v) const { return moments(v, 0).mean; }
  Moments moments(const Vertex& v, std::uint32_t of_class) const {
    return samples_ == 0 ? Moments{} : moments_[index(cell(v, of_class))];
  }
  bool learns() const { return samples_ < enough_ || rounds_.ended() < least_rounds; }
  /// One path's value at `v`; only while it learns().
  void record(const Vertex& v, double value, Accumulator& accumulator) const {
    if (std::isfinite(value)) accumulator.add(key(v, 0), {value});
  }
  /// The finest cell of `v`, for a sample that is known later.
  std::uint32_t key(const Vertex& v, std::uint32_t of_class) const {
    return static_cast<std::uint32_t>(index(cell(v, of_class)));
  }
  /// Adds the samples of `iterations`, in the order of their parts.
  void update(std::span<const Accumulator* const> accumulators, double iterations);
  /// The same, one by one and then once for an iteration.
  void add(std::uint32_t key, const Sample& sample) {
    if (std::isfinite(sample.value)) learning_[key] += Samples::of(sample);
  }
  void end_iteration() { end(1); }

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error for the state of another scene.
  void load(ByteReader& in);

 private:
  static constexpr int side = 32, sides = 6;
  static constexpr std::size_t levels = 6;  // 32, 16, ..., 1 cells along a side
  /// Samples below which a look-up uses the coarser cell.
  static constexpr double least_samples = 128;
  static constexpr std::uint64_t least_rounds = 3;

  struct Cell {
    std::array<std::uint32_t, 3> at;
    std::uint32_t side;  // of the normal, and the class
  };
  std::array<double, 5> grid() const {
    return {low_.x, low_.y, low_.z, scale_, double(known_.size())};
  }
  Cell cell(const Vertex& v, std::uint32_t of_class) const;
  static std::size_t index(const Cell& c);
  static Moments moments(const Samples& s);
  /// The place in the next coarser grid of place `i` in one of `n` cells along a side.
  static std::size_t above(std::size_t i, std::size_t n);
  void make_moments();
  void end(double iterations);

  V3d low_{0.0};
  double scale_ = 0, enough_ = 0;
  struct Saved {
    Samples met;
    std::uint64_t cell;
  };
  LearningRounds rounds_;
  double samples_ = 0;                     // in known_
  std::vector<Samples> known_, learning_;  // of the finest grid: the last round's, and this one's
  std::vector<Moments> moments_;           // of the finest grid, from where enough were met
};

}  // namespace lacuna
