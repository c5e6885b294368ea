#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/geometry/morton.h"
#include "renderer/core/passes.h"
#include "renderer/integrators/integrators.h"
#include "renderer/integrators/path_tracer.h"
#include "renderer/integrators/seen_emission.h"
#include "renderer/mutations/registry.h"
#include "renderer/path/tiles.h"

namespace lacuna {

namespace {

/// The number of independent samples, chains and mutations of an iteration.
struct ChainPlan {
  std::int64_t samples = 0;  ///< independent samples of the bootstrap
  std::int64_t chains = 0;
  std::int64_t mutations = 0;  ///< of each chain
};

/// Metropolis light transport (Veach and Guibas 1997; Noel 2015, 4.6). Each iteration is an
/// independent estimate: independent samples give the brightness of the picture, and chains start
/// at samples selected in proportion to their contribution. So there is no start-up bias, and the
/// estimate is unbiased without a burn-in (Veach 1997, 11.3.1). Because iterations are independent,
/// the variance of the film and its two halves show the true error.
template <Mutation M, class Settings>
class Metropolis final : public Integrator {
 public:
  Metropolis(const MetropolisSettings& settings, const Settings& mutation)
      : settings_(settings), mutation_(mutation), direct_(direct_settings(settings), Guide{}) {}

  SceneNeeds needs() const override { return {.materials = true, .emission = true}; }

  void prepare(const PrepareContext& context) override {
    if (settings_.direct_samples == 0) seen_.prepare(context);
  }

  Counters iterate(const IterationContext& context, Image& image) override {
    Counters counters;
    trace_direct(context, image, counters);
    if (settings_.max_depth < least_edges() || context.scene.emitters().empty()) return counters;
    const double pixels = double(image.width) * image.height;
    const ChainPlan plan = make_plan(pixels);
    Passes passes(context.pool);
    passes.begin("bootstrap", seconds_.bootstrap);
    std::vector<Sample> samples(static_cast<std::size_t>(plan.samples));
    counters += bootstrap(context, samples);
    std::erase_if(samples, [](const Sample& s) { return !(s.scalar > 0); });
    if (samples.empty()) return counters;
    std::ranges::sort(samples, {}, [](const Sample& s) { return std::pair(s.order, s.number); });
    double sum = 0;
    for (const Sample& s : samples) sum += s.scalar;
    const std::vector<std::size_t> starts = choose_starts(context, plan, samples, sum);
    // A chain's states have the density scalar / brightness.
    const double brightness = sum / static_cast<double>(plan.samples);
    brightness_.add(samples, sum, static_cast<double>(plan.samples));
    const double share = brightness * pixels / double(plan.chains * plan.mutations);
    passes.begin("chains", seconds_.chains);
    counters += run_chains(context, plan, starts, share, image);
    return counters;
  }

  std::vector<std::pair<std::string, double>> statistics() const override {
    const auto rate = [](std::uint64_t n, std::uint64_t of) {
      return of > 0 ? double(n) / double(of) : 0.0;
    };
    std::vector<std::pair<std::string, double>> list{
        {"mutations", proposed()},
        {"uneven_pixels", static_cast<double>(seen_.uneven_pixels())},
        {"brightness_relative_error", brightness_.relative_error()},
        {"mutations_per_cpu_second", seconds_.chains > 0 ? proposed() / seconds_.chains : 0.0},
        {"bootstrap_cpu_seconds", seconds_.bootstrap},
        {"chains_cpu_seconds", seconds_.chains}};
    for (std::size_t i = 0; i < M::kinds.size(); ++i) {
      list.emplace_back(fmt::format("{}_proposals", M::kinds[i]), double(proposed_[i]));
      list.emplace_back(fmt::format("{}_acceptance", M::kinds[i]),
                        rate(accepted_[i], proposed_[i]));
    }
    return list;
  }

 private:
  using ByKind = std::array<std::uint64_t, M::kinds.size()>;  ///< numbers by kind of proposal

  /// Mutations of all kinds.
  double proposed() const {
    return double(std::accumulate(proposed_.begin(), proposed_.end(), std::uint64_t{0}));
  }
  static PathSettings direct_settings(const MetropolisSettings& s) {
    PathSettings direct;
    direct.max_depth = std::min(2, s.max_depth);
    direct.roulette_depth = direct.max_depth;
    return direct;
  }
  ChainPaths paths() const { return {settings_, least_edges()}; }
  int least_edges() const { return settings_.direct_samples > 0 ? 3 : 2; }

  /// Adds the light of the paths that chains leave out.
  void trace_direct(const IterationContext& context, Image& image, Counters& counters) {
    if (settings_.direct_samples == 0) {
      counters += seen_.add(context, settings_.mutations, image);
      return;
    }
    const auto share = 1.0F / static_cast<float>(settings_.direct_samples);
    for (int i = 0; i < settings_.direct_samples; ++i) {
      // A job's seed is below 2^53.
      const std::uint64_t seed = context.seed | static_cast<std::uint64_t>(i) << 53;
      Image sample(image.width, image.height);
      counters += direct_.iterate({.scene = context.scene,
                                   .camera = context.camera,
                                   .pool = context.pool,
                                   .seed = seed,
                                   .iteration = context.iteration,
                                   .stop = context.stop,
                                   .light = context.light.times(share)},
                                  sample);
      for (std::size_t k = 0; k < image.pixels.size(); ++k) {
        image.pixels[k] += sample.pixels[k] * share;
      }
    }
  }

  ChainPlan make_plan(double pixels) const {
    const auto at_least_one = [](double n) {
      return std::max(std::int64_t{1}, static_cast<std::int64_t>(std::ceil(n)));
    };
    return {std::max(at_least_one(pixels * settings_.bootstrap), std::int64_t{settings_.chains}),
            settings_.chains, at_least_one(pixels * settings_.mutations / settings_.chains)};
  }

  /// The generator of independent sample `n`.
  static Rng sample_rng(const IterationContext& context, std::size_t n) {
    return Rng(context.seed, context.iteration, n, Rng::Purpose::bootstrap);
  }

  /// An independent sample of the bootstrap.
  struct Sample {
    double scalar = 0;
    std::uint32_t order = 0;  ///< of its brightest pixel along a Morton curve
    std::size_t number = 0;   ///< of its generator
  };
  /// The brightness of the picture, over iterations.
  struct Brightness {
    double sum = 0, variance = 0;  ///< of the estimates of the iterations

    /// `sum_`: of the scalars of all `n` samples, of which those in `found` are not 0.
    void add(std::span<const Sample> found, double sum_, double n) {
      const double mean = sum_ / n;
      double squares = mean * mean * (n - static_cast<double>(found.size()));
      for (const Sample& s : found) squares += (s.scalar - mean) * (s.scalar - mean);
      sum += mean;
      if (n > 1) variance += squares / (n * (n - 1));
    }
    /// Standard error over the value.
    double relative_error() const { return sum > 0 ? std::sqrt(variance) / sum : 0; }
  };
  static std::uint32_t film_order(const ChainState& state, int width) {
    const auto brightest = std::ranges::max_element(
        state.pixels, {}, [](const ChainState::Pixel& p) { return luminance(p.value); });
    if (brightest == state.pixels.end()) return 0;
    const auto w = static_cast<std::uint32_t>(width);
    return static_cast<std::uint32_t>(morton_code(brightest->index % w, brightest->index / w, 0));
  }

  /// Evaluates the independent samples. Each depends on its number alone, so that a chain can
  /// evaluate its first one again.
  Counters bootstrap(const IterationContext& context, std::vector<Sample>& samples) const {
    constexpr std::size_t part = 16 * M::size;
    const int parts = static_cast<int>((samples.size() + part - 1) / part);
    return for_each_part(context, parts, [&](int i, Counters& counters) {
      M m(mutation_, paths());
      typename M::Workspace workspace(context, settings_);
      const std::size_t end = std::min(samples.size(), (std::size_t(i) + 1) * part);
      for (std::size_t first = std::size_t(i) * part; first < end; first += M::size) {
        const std::size_t n = std::min(end - first, std::size_t{M::size});
        std::vector<Rng> rngs;
        for (std::size_t k = 0; k < n; ++k) rngs.push_back(sample_rng(context, first + k));
        for (std::size_t k = 0; k < n; ++k) m.start(k, rngs[k]);
        m.evaluate(n, workspace, counters);
        for (std::size_t k = 0; k < n; ++k) {
          const ChainState& state = m.proposed(k);
          samples[first + k] = {state.scalar, film_order(state, context.camera.width()), first + k};
        }
      }
    });
  }

  /// Numbers of the samples at which the chains start. Systematic resampling, in proportion to the
  /// scalars and in the order of the film, gives each region its share of the chains.
  static std::vector<std::size_t> choose_starts(const IterationContext& context,
                                                const ChainPlan& plan,
                                                std::span<const Sample> samples, double sum) {
    constexpr std::uint64_t no_chain = (std::uint64_t{1} << 56) - 1;
    Rng rng(context.seed, context.iteration, no_chain, Rng::Purpose::chain);
    const double offset = rng.next_choice(), step = sum / static_cast<double>(plan.chains);
    std::vector<std::size_t> starts;
    double before = 0;
    std::size_t n = 0;
    for (std::int64_t c = 0; c < plan.chains; ++c) {
      const double at = (static_cast<double>(c) + offset) * step;
      // Sums may round to less than the last positions.
      while (n + 1 < samples.size() && before + samples[n].scalar <= at) {
        before += samples[n++].scalar;
      }
      starts.push_back(samples[n].number);
    }
    return starts;
  }

  /// Advances all chains and adds the contributions of their states to `image`, times `share`.
  Counters run_chains(const IterationContext& context, const ChainPlan& plan,
                      const std::vector<std::size_t>& starts, double share, Image& image) {
    // Limits of memory: chains at a time, and mutations between two additions of splats.
    constexpr std::size_t together = 1024;
    constexpr std::int64_t round = 512;
    // A few batches for each thread; the results do not depend on the size of the batches.
    const auto of_batch = std::clamp(starts.size() / (4 * std::size_t(context.pool.threads())),
                                     std::size_t{1}, std::size_t{M::size});
    Counters sum;
    for (std::size_t first = 0; first < starts.size(); first += together) {
      const std::size_t end = std::min(first + together, starts.size());
      std::vector<std::unique_ptr<Batch>> running((end - first + of_batch - 1) / of_batch);
      for (std::int64_t done = 0; done < plan.mutations; done += round) {
        const auto work = [&](int i, Counters& counters, Splats& splats) {
          typename M::Workspace workspace(context, settings_);
          std::unique_ptr<Batch>& batch = running[static_cast<std::size_t>(i)];
          if (batch == nullptr) {
            const std::size_t chain = first + static_cast<std::size_t>(i) * of_batch;
            batch = std::make_unique<Batch>(*this, share);
            batch->start(std::span(starts).subspan(chain, std::min(of_batch, end - chain)), chain,
                         context, workspace, counters);
          }
          const std::int64_t steps = std::min(round, plan.mutations - done);
          for (std::int64_t k = 0; k < steps; ++k) {
            if (k % 16 == 0) context.check_stop();
            batch->advance(workspace, counters);
          }
          if (done + steps == plan.mutations) batch->finish();
          batch->take_splats(splats);
        };
        sum += for_each_splatting_part(context, static_cast<int>(running.size()), image, work,
                                       [](const Splat&) {});
      }
      for (const auto& batch : running) {
        for (std::size_t kind = 0; kind < M::kinds.size(); ++kind) {
          proposed_[kind] += batch->proposed[kind];
          accepted_[kind] += batch->accepted[kind];
        }
      }
    }
    return sum;
  }

  /// Chains that one thread advances together.
  struct Batch {
    Batch(const Metropolis& of, double share_) : m(of.mutation_, of.paths()), share(share_) {}

    /// `starts`: numbers of the samples; `first`: number of the first chain.
    void start(std::span<const std::size_t> starts, std::size_t first,
               const IterationContext& context, typename M::Workspace& workspace,
               Counters& counters) {
      std::vector<Rng> samples;
      for (const std::size_t s : starts) samples.push_back(sample_rng(context, s));
      for (std::size_t k = 0; k < starts.size(); ++k) {
        m.start(k, samples[k]);
        rngs.emplace_back(context.seed, context.iteration, first + k, Rng::Purpose::chain);
      }
      m.evaluate(starts.size(), workspace, counters);
      for (std::size_t k = 0; k < starts.size(); ++k) m.accept(k);
    }

    void advance(typename M::Workspace& workspace, Counters& counters) {
      const std::size_t n = rngs.size();
      for (std::size_t k = 0; k < n; ++k) m.propose(k, rngs[k]);
      m.evaluate(n, workspace, counters);
      for (std::size_t k = 0; k < n; ++k) decide(k);
    }

    /// Both states contribute, weighted by the probability that the chain is in them next: expected
    /// values instead of one sample (Veach 1997, 11.3.2.1).
    void decide(std::size_t k) {
      const double a = m.proposed(k).scalar > 0 ? std::min(1.0, m.acceptance_ratio(k)) : 0.0;
      stay[k] += 1 - a;
      const std::size_t kind = m.kind(k);
      ++proposed[kind];
      if (rngs[k].decide(static_cast<float>(a))) {
        ++accepted[kind];
        deposit(m.current(k), stay[k], splats_of[k]);
        m.accept(k);
        stay[k] = a;
      } else if (a > 0) {
        deposit(m.proposed(k), a, splats_of[k]);
      }
    }

    void finish() {
      for (std::size_t k = 0; k < rngs.size(); ++k) deposit(m.current(k), stay[k], splats_of[k]);
    }

    /// Appends the splats since the last call, chain after chain.
    void take_splats(Splats& splats) {
      for (Splats& own : splats_of) {
        splats.insert(splats.end(), own.begin(), own.end());
        own.clear();
      }
    }

    void deposit(const ChainState& state, double weight, Splats& splats) const {
      if (weight == 0 || state.scalar == 0) return;
      const double scale = weight * share / state.scalar;
      const auto scaled = [&](const Rgb& value) {
        return Rgb(static_cast<float>(double(value.x) * scale),
                   static_cast<float>(double(value.y) * scale),
                   static_cast<float>(double(value.z) * scale));
      };
      for (const ChainState::Pixel& p : state.pixels) {
        splats.push_back({scaled(p.value), 1.0F, p.index, Splat::any_length});
      }
      for (const ChainState::Part& p : state.parts) {
        splats.push_back({scaled(p.value), 1.0F, p.index, p.edges, p.matches, true});
      }
    }

    M m;
    double share;
    std::vector<Rng> rngs = {};
    std::array<Splats, M::size> splats_of = {};
    std::array<double, M::size> stay{};  // weight of the current state that is not deposited yet
    ByKind proposed{}, accepted{};
  };

  MetropolisSettings settings_;
  Settings mutation_;
  PathTracer direct_;  // of direct_samples
  SeenEmission seen_;  // without them
  ByKind proposed_{}, accepted_{};
  Brightness brightness_;
  /// CPU seconds of all threads in the parts of an iteration.
  struct {
    double bootstrap = 0, chains = 0;
  } seconds_;
};

}  // namespace

std::unique_ptr<Integrator> make_metropolis(const MetropolisSettings& settings) {
  return MutationRegistry::visit(
      settings.mutation, [&]<Mutation M>(const auto& mutation) -> std::unique_ptr<Integrator> {
        return std::make_unique<Metropolis<M, std::decay_t<decltype(mutation)>>>(settings,
                                                                                 mutation);
      });
}

}  // namespace lacuna
