#pragma once

#include <array>
#include <span>
#include <vector>

#include "renderer/film/image.h"
#include "renderer/guides/reflected_radiance.h"
#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"
#include "renderer/path/eye_batch.h"
#include "renderer/path/roulette.h"

namespace lacuna {

/// Efficiency-aware Russian roulette and splitting (Rath, Grittmann, Herholz, Weier and Slusallek
/// 2022, "EARS"). A path of throughput T goes on at a vertex
///
///     q = T sqrt(S / C) / sqrt(V_I / C_I)
///
/// times, with S the second moment (q < 1) or the variance (q > 1) of what one continuation gathers
/// for throughput 1, C its rays, V_I the variance of a sample of a pixel, mean over the picture,
/// and C_I its rays: that minimises V_I C_I. A path ends by the V_I without the pixels that differ
/// most, and splits by that of all of them: where one rare path is most of the noise so far, V_I is
/// not known, and a path that goes on as it is costs little either way. S and C are learned in
/// cells (ReflectedRadiance), from paths that were ended and split by the q before (a fixed point).
/// Costs are counted in rays, because clocks would change the bits. The paper divides T by the
/// pixel, which makes the picture's relative error small where this makes the squared error small.
///
/// Samples that are spread evenly (Sampler::sobol) have a smaller error than their variance says,
/// and such roulette loses by it. So a first span of iterations has none, and where the picture's
/// two halves differ by clearly less than the variance of samples says, a second span tries
/// roulette by throughput from early_roulette_depth edges on instead, which leaves the first edges
/// as they are: it stays if the product of squared error and rays has become smaller. Elsewhere the
/// second span tries what was learned, and it stays unless that product has become clearly larger.
class EfficiencyRoulette final : public Roulette {
 public:
  /// What one continuation of a path gathered.
  struct Continuation {
    std::uint32_t cell;
    float rays;
    double value;
  };
  using Accumulator = std::vector<Continuation>;

  EfficiencyRoulette() = default;
  /// For pictures of so many pixels.
  EfficiencyRoulette(const Scene& scene, std::size_t pixels);

  /// Whether paths of the coming iteration end by their throughput from early_roulette_depth edges
  /// on.
  bool ends_early() const {
    return state_.stage == Stage::early_trial || state_.stage == Stage::early;
  }
  /// Whether it decides in the coming iteration.
  bool active() const { return state_.stage == Stage::trial || state_.stage == Stage::stays; }
  /// Whether update() wants a coming iteration.
  bool observes() const { return in_first_spans() || learns(); }
  /// Whether update() wants its continuations, too.
  bool learns() const { return !ends_early() && state_.stage != Stage::ended && moments_.learns(); }

  /// Whether update() wants those of the batch of paths whose first one is of `pixel`: where the
  /// pictures are large, or many, a share is enough.
  bool learns_from(std::size_t pixel, std::uint64_t iteration) const {
    const std::uint64_t share =
        (pixels_ + most_paths - 1) / most_paths * (state_.stage == Stage::stays ? later_share : 1);
    return (pixel / EyeBatch::size + iteration) % share == 0;
  }
  /// The cell of a continuation.
  std::uint32_t key(const Vertex& v, int edges_left) const {
    return moments_.key(v, vertex_class(edges_left));
  }
  /// Adds an iteration's whole picture of one sample a pixel.
  void update(std::span<const Accumulator> accumulators, const IterationContext& context,
              const Image& image, const Counters& sum);

  float continuations(const Vertex& v, int edges_left, float throughput) const override;
  /// The same for the moments of one continuation.
  static float continuations(const ReflectedRadiance::Moments& m, float for_survival,
                             float for_splitting);

  std::vector<std::pair<std::string, double>> statistics() const;
  void save(ByteWriter& out) const;
  /// Throws std::runtime_error for the state of another scene.
  void load(ByteReader& in);

 private:
  /// Checkpoints hold these numbers.
  enum class Stage : std::uint32_t {
    plain = 0,
    trial = 1,
    stays = 2,
    ended = 3,
    early_trial = 4,
    early = 5
  };
  /// It is not decided yet what stays.
  bool in_first_spans() const {
    return state_.stage == Stage::plain || state_.stage == Stage::trial ||
           state_.stage == Stage::early_trial;
  }

  /// Of an iteration that are learned from: their continuations take some megabytes.
  static constexpr std::uint64_t most_paths = std::uint64_t{1} << 16;
  /// One batch in so many: of all paths, learning takes a third of the time of an iteration.
  static constexpr std::uint64_t later_share = 3;
  /// The last edges of a path gather other light than longer ones; all others share cells.
  static constexpr int classes = 3;
  static std::uint32_t vertex_class(int edges_left) {
    return static_cast<std::uint32_t>(std::min(edges_left, int{classes}) - 1);
  }

  /// What a span of iterations tells of a pixel's sample.
  struct Efficiency {
    double variance = 0;  ///< of one, mean over the pixels
    double spread = 0;    ///< the same as the halves tell: less, where samples are spread
    double trimmed = 0;   ///< `spread` without the pixels whose halves differ most
    double doubt = 0;     ///< the squared deviation of `spread` over its square
    double rays = 0;
    double expense() const { return spread * rays; }
  };
  Efficiency measured() const;
  void end_span();

  struct State {
    Stage stage = Stage::plain;
    std::uint32_t span = 0;                     // iterations of this span
    std::array<std::uint32_t, 2> iterations{};  // of this span: even and odd ones
    double squares = 0;                         // of all samples of this span
    double rays = 0, samples = 0;               // of this span
    Efficiency plain, tried;
    float for_survival = 0, for_splitting = 0;  // sqrt(C_I / V_I), by `trimmed` and by `variance`
  };
  State state_;
  std::size_t pixels_ = 0;
  ReflectedRadiance moments_;
  std::array<std::vector<double>, 2> sums_;  // of the pixels' samples, by even and odd iterations
};

}  // namespace lacuna
