#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/core/density.h"
#include "renderer/core/power8.h"
#include "renderer/core/rng.h"
#include "renderer/guides/lobe_set.h"
#include "renderer/path/training_samples.h"

namespace lacuna {

/// A mixture of von Mises-Fisher lobes. A lobe is aimed at a point, so its direction depends on the
/// position where it is sampled (parallax; Ruppert, Herholz and Lensch 2020, 5). Or its direction
/// is constant, if that makes it narrower: light from surfaces close to each position arrives at a
/// single pivot from all sides. The mixture is fitted to observed light by batched expectation
/// maximisation; of earlier batches only the sufficient statistics are kept.
class AimedLobes {
 public:
  static constexpr std::size_t count = 8;

  AimedLobes() = default;
  /// Initial lobes, aimed from `pivot` at the `targets` of largest weight; empty() without targets.
  AimedLobes(const V3f& pivot, std::span<const Target> targets);

  /// Whether nothing can be sampled.
  bool empty() const { return !initialised_; }

  /// Samples a unit direction at `x`; none if the selected lobe is aimed at `x` itself. Requires
  /// !empty().
  std::optional<V3f> sample(const V3f& x, Rng::FinePoint u) const;
  /// Density with which sample() returns unit `w`.
  Pdf<SolidAngle> pdf(const V3f& x, const V3f& w) const {
    return Pdf<SolidAngle>(reduce_add(packed_.densities(x - pivot_, {w.x, w.y, w.z})));
  }

  /// Fits the lobes to the light that arrived at `samples`, at positions close together, and to the
  /// statistics of earlier batches.
  void learn(std::span<const TrainingSample> samples);
  /// Halves the weight of everything learned so far, and moves the pivot to the mean position of
  /// the samples since the last call.
  void next_round();

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error if the data is not valid.
  void load(ByteReader& in);

 private:
  /// A direction that depends on the position: that of axis - inverse_distance d at pivot_ + d.
  struct Aim {
    V3d axis{0, 0, 1};            ///< unit
    double inverse_distance = 0;  ///< of the target point; 0: the same direction everywhere

    /// Keeps the target point while pivot_ moves by `d`. No effect if the pivot moves to that
    /// point.
    void move(const V3d& d);
  };
  struct Lobe {
    Aim aim;
    double concentration = 1;  ///< kappa
    double share = 0;          ///< mixture weight
    bool aimed = true;         ///< at a point; else constant
  };
  /// All lobes, in structure-of-arrays layout.
  struct alignas(32) Packed {
    std::array<float, count> x{}, y{}, z{}, inverse_distance{};
    std::array<float, count> exponent_scale{};  ///< minus kappa / (2 ln 2)
    std::array<float, count> peak{};            ///< mixture weight times the density on the axis
    unsigned aimed = 0;                         ///< a bit for each lobe

    /// exp(kappa (cos - 1)), with 2 (1 - cos) the squared distance of the unit vectors, which is
    /// more precise near the axis than the cosine.
    Float8 densities(const V3f& from, const Float8x3& w) const {
      const Float8 i = Float8::load(inverse_distance.data());
      const Float8x3 to{Float8::load(x.data()) - i * from.x, Float8::load(y.data()) - i * from.y,
                        Float8::load(z.data()) - i * from.z};
      const Float8 square = length2(to);
      const Float8 scale = 1.0F / sqrt(square);
      const Float8x3 apart = to * scale - w;
      const Float8 bits = Float8::load(exponent_scale.data()) * length2(apart);
      return keep_where(square > 0.0F, Float8::load(peak.data()) * exp2(bits));
    }
  };
  static_assert(count == 8);
  /// Sufficient statistics: sums over samples, for each lobe weighted by its responsibility.
  struct Statistics {
    double weight = 0, squares = 0;  // over all samples; squares: of weights
    struct LobeStatistics {
      double weight = 0, inverse_distance = 0;
      V3d from_pivot{0, 0, 0}, from_position{0, 0, 0};  ///< sums of directions
    };
    std::array<LobeStatistics, count> lobes{};

    void add(const Statistics& other, double scale);
  };
  /// A sample of light relative to the pivot.
  struct LobeObservation {
    V3f from_pivot, from_position;  ///< unit directions to the source of the light
    float inverse_distance, weight;
  };

  /// Light observed by a path: position, direction, distance of its source and weight.
  struct ArrivingLight {
    V3f x, w;
    float distance, weight;
  };
  static std::vector<ArrivingLight> arriving_light(std::span<const TrainingSample> samples);
  double weight_limit(std::span<const ArrivingLight> batch) const;
  void initialise(const V3f& pivot);
  LobeObservation observe(const ArrivingLight& light) const;
  Statistics expectation(std::span<const LobeObservation> batch) const;
  void maximise(const Statistics& statistics);
  void move_pivot(const V3f& to);
  void pack();
  template <class Self, class Use>
  static void for_each_number(Self& self, const Use& use);

  Packed packed_;
  std::array<Lobe, count> lobes_{};
  Statistics statistics_;
  V3d position_sum_{0, 0, 0};  // sum over the samples of this round
  double position_count_ = 0;  // number of these samples
  V3f pivot_{0, 0, 0};
  bool initialised_ = false;  // the lobes are set
};

}  // namespace lacuna
