#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/path/learning_rounds.h"
#include "renderer/path/training_samples.h"

namespace lacuna {

/// An estimate of the indirect radiance that a vertex reflects: the luminance of a path's
/// contributions at later vertices over the luminance of its throughput at the vertex. Emission and
/// next event estimation at the vertex itself are not included. Roulette and splitting of guided
/// paths use it as the adjoint (Vorba and Krivanek 2016, "Adjoint-driven Russian roulette and
/// splitting").
///
/// A grid of 32^3 cells over the scene, each with six sides for the normals, and coarser grids of
/// 16^3 to 1 cells: a look-up returns the mean of the finest cell with enough samples. It learns in
/// LearningRounds; each round replaces the one before, because the first paths have the heaviest
/// tails. The expected picture does not depend on the estimate.
class ReflectedRadiance {
 public:
  ReflectedRadiance() = default;
  /// Over the box of a scene, low corner and size, in scene units.
  ReflectedRadiance(const V3d& low, const V3d& size);

  /// The estimate at the surface vertex `v`; below 0 while there are no samples.
  float at(const Vertex& v) const {
    return samples_ == 0 ? -1.0F : means_[index(v.surface.x, v.side())];
  }
  bool learns() const { return samples_ < enough_samples || rounds_.ended() < least_rounds; }
  /// Adds the samples of a pass.
  void update(const TrainingSamples& samples);

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error for the state of another scene.
  void load(ByteReader& in);

 private:
  static constexpr std::size_t levels = 6;
  static constexpr int sides = 6, side = 1 << (levels - 1);  // 32, 16, ..., 1 cells along a side
  /// Samples below which a look-up uses the coarser cell.
  static constexpr double least_samples = 128;
  /// Learning ends after a round with this many samples.
  static constexpr double enough_samples = 1 << 18;
  static constexpr std::uint64_t least_rounds = 3;

  /// Sum and number of the samples of a cell.
  struct Samples {
    double sum = 0, samples = 0;
    void operator+=(const Samples& o) {
      sum += o.sum;
      samples += o.samples;
    }
    float mean() const { return static_cast<float>(sum / samples); }
  };
  struct Saved {
    Samples samples;
    std::uint64_t cell;
  };

  std::array<double, 4> grid() const { return {low_.x, low_.y, low_.z, scale_}; }
  std::size_t index(const V3f& x, const V3f& n) const;
  /// Index in grid `level` + 1, the next coarser one, of the cell that contains cell `i` of grid
  /// `level`.
  static std::size_t above(std::size_t i, std::size_t level);
  void make_means();

  V3d low_{0.0};
  double scale_ = 0;
  LearningRounds rounds_;
  double samples_ = 0;                     // number in known_
  std::vector<Samples> known_, learning_;  // finest grid: of the last round, of the current one
  std::vector<float> means_;  // finest grid: mean of the finest level with enough samples
};

}  // namespace lacuna
