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

/// A mixture of von Mises-Fisher lobes. A lobe is aimed at a point, so that its direction depends
/// on where it is sampled: parallax (Ruppert, Herholz and Lensch 2020, 5). Or its direction is the
/// same everywhere, if that makes it narrower: light from surfaces beside each place comes from all
/// sides when it is seen from one pivot. The mixture is fitted to light that was found, by
/// expectation maximisation batch by batch: of earlier batches only sums are kept.
class AimedLobes {
 public:
  static constexpr std::size_t count = 8;

  AimedLobes() = default;
  /// Lobes aimed at the heaviest of `targets`, as seen from `pivot`, before anything is learned;
  /// empty() without targets.
  AimedLobes(const V3f& pivot, std::span<const Target> targets);

  /// Nothing can be sampled.
  bool empty() const { return !begun_; }

  /// Samples a unit direction at `x`; nothing where the chosen lobe is aimed at `x` itself.
  /// Requires lobes that are not empty().
  std::optional<V3f> sample(const V3f& x, Rng::FinePoint u) const;
  /// Density with which sample() returns unit `w`.
  Pdf<SolidAngle> pdf(const V3f& x, const V3f& w) const {
    return Pdf<SolidAngle>(reduce_add(packed_.densities(x - pivot_, {w.x, w.y, w.z})));
  }

  /// Fits to the light that arrived at `samples`, all at places near each other, and to what was
  /// learned before.
  void learn(std::span<const TrainingSample> samples);
  /// What has been learned so far counts half from here on, and distances are kept as seen from the
  /// middle of the places since the last call.
  void next_round();

  void save(ByteWriter& out) const;
  /// Throws std::runtime_error if the data is not valid.
  void load(ByteReader& in);

 private:
  /// A direction that depends on the place: that of axis - inverse_distance d at pivot_ + d.
  struct Aim {
    V3d axis{0, 0, 1};            ///< unit
    double inverse_distance = 0;  ///< of the point; 0: everywhere the same

    /// Of the same point, where pivot_ moves by `d`. Unchanged where that is the point itself.
    void move(const V3d& d);
  };
  struct Lobe {
    Aim aim;
    double concentration = 1;  ///< kappa
    double share = 0;          ///< of all samples
    bool aimed = true;         ///< at a point
  };
  /// All lobes side by side.
  struct alignas(32) Packed {
    std::array<float, count> x{}, y{}, z{}, inverse_distance{};
    std::array<float, count> fall{};  ///< minus kappa / (2 ln 2)
    std::array<float, count> peak{};  ///< share times the density on the axis
    unsigned aimed = 0;               ///< a bit for each lobe

    /// exp(kappa (cos - 1)), where 2 (1 - cos) is the squared distance of the unit vectors: near
    /// the axis that is more precise than the cosine.
    Float8 densities(const V3f& from, const Float8x3& w) const {
      const Float8 i = Float8::load(inverse_distance.data());
      const Float8x3 to{Float8::load(x.data()) - i * from.x, Float8::load(y.data()) - i * from.y,
                        Float8::load(z.data()) - i * from.z};
      const Float8 square = length2(to);
      const Float8 scale = 1.0F / sqrt(square);
      const Float8x3 apart = to * scale - w;
      const Float8 bits = Float8::load(fall.data()) * length2(apart);
      return keep_where(square > 0.0F, Float8::load(peak.data()) * exp2(bits));
    }
  };
  static_assert(count == 8);
  /// Sums over samples: of each lobe, by how much they belong to it.
  struct Evidence {
    double weight = 0, squares = 0;  // of all samples
    struct OfLobe {
      double weight = 0, inverse_distance = 0;
      V3d from_pivot{0, 0, 0}, from_place{0, 0, 0};  ///< sums of directions
    };
    std::array<OfLobe, count> lobes{};

    void add(const Evidence& other, double scale);
  };
  /// A sample of light.
  struct Seen {
    V3f from_pivot, from_place;  ///< unit directions to where the light came from
    float inverse_distance, weight;
  };

  /// Light that a path found.
  struct Found {
    V3f x, w;
    float distance, weight;
  };
  static std::vector<Found> found(std::span<const TrainingSample> samples);
  double most_weight(std::span<const Found> batch) const;
  void begin(const V3f& pivot);
  Seen seen(const Found& light) const;
  Evidence expect(std::span<const Seen> batch) const;
  void maximise(const Evidence& evidence);
  void move_pivot(const V3f& to);
  void pack();
  template <class Self, class Use>
  static void for_each_number(Self& self, const Use& use);

  Packed packed_;
  std::array<Lobe, count> lobes_{};
  Evidence evidence_;
  V3d places_{0, 0, 0};  // of the samples of this round, summed
  double placed_ = 0;    // their number
  V3f pivot_{0, 0, 0};
  bool begun_ = false;  // the lobes are set
};

}  // namespace lacuna
