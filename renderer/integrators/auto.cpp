#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "base/parallel/stop.h"
#include "renderer/core/clock_seconds.h"
#include "renderer/film/saved_values.h"
#include "renderer/integrators/candidates.h"
#include "renderer/integrators/integrator.h"
#include "renderer/integrators/integrators.h"
#include "renderer/race/picture_halves.h"
#include "renderer/race/plan.h"
#include "renderer/race/record.h"
#include "renderer/race/verdict.h"

namespace lacuna {

namespace {

/// Budgets from this on are worth an analysis of the space by default, seconds.
constexpr double worth_an_analysis = 10;
/// The part of the race that a candidate's first iteration may take.
constexpr double longest_first = 0.25;
/// The factor by which an entrant must surely have been worse in an earlier race to be left out.
constexpr double surely_worse = 2;
/// Estimates of both from which on an earlier race counts, if the best's tail is known, too: fewer
/// may have missed all bright paths.
constexpr std::uint64_t worth_keeping = 4;
/// Pixels of the pictures that tell what an iteration costs.
constexpr std::size_t probe_pixels = 2048;
/// The first of the two sequences of the race's pictures; 0 and 1 are those of the film's halves.
constexpr std::uint32_t of_the_race = 2;
/// Estimates that a budget is divided into. What a plan does in one is decided before it begins.
constexpr double estimates_of_a_budget = 64;
constexpr double infinite = std::numeric_limits<double>::infinity();

std::uint32_t half_of(const IterationContext& context) {
  return SampleNumber::of_iteration(context.iteration).randomisation;
}

struct Candidate {
  std::string name;
  std::unique_ptr<Integrator> integrator;
  bool spreads = true;  ///< its samples, with `sobol`
  bool prepared = false;
  double preparation = 0;
};

/// The first iteration holds the race, whose pictures serve decisions alone. Every estimate of the
/// picture, one an iteration, is made by a plan that was fixed before it began, so that it is
/// unbiased whatever the plan. Plans are made anew after 4, 8, 16... estimates.
class Auto final : public Integrator {
 public:
  explicit Auto(const AutoSettings& settings) : settings_(settings) {
    for (const IntegratorSettings& c : candidates(settings)) {
      candidates_.push_back({.name = candidate_name(c),
                             .integrator = make_integrator(c),
                             .spreads = spreads_samples(c)});
    }
  }

  SceneNeeds needs() const override {
    SceneNeeds all;
    for (const Candidate& c : candidates_) {
      const SceneNeeds one = c.integrator->needs();
      all.materials |= one.materials;
      all.emission |= one.emission;
      all.space |= one.space;
      all.light_tree |= one.light_tree;
    }
    return all;
  }

  void prepare(const PrepareContext& context) override;
  Counters iterate(const IterationContext& context, Image& image) override;
  const RaceRecord* race() const override;
  void save(ByteWriter& out) const override;
  void load(ByteReader& in) override;

 private:
  bool counts_rays() const { return settings_.clock == RaceClock::rays; }
  bool remembers() const { return settings_.remember && !counts_rays(); }
  /// What an earlier race found, if it counts.
  void recall(const PrepareContext& context);
  void keep_verdict() const;
  /// Why a candidate does not take part; empty: it does.
  std::string excluded(std::size_t k, const PrepareContext& context) const;
  /// One iteration of a candidate, of `parts` of the picture. Returns its cost. `sample`: its
  /// number in the sequences of `sobol`.
  double render(std::size_t k, const IterationContext& context, SampleNumber sample, Image& image,
                std::span<const Tile> parts = {});
  /// Renders one of the race's iterations and calls `finished(image, cost)`; a candidate that takes
  /// longer than `longest` or fails leaves.
  template <class Finished>
  void attempt(std::size_t k, const IterationContext& context, const Camera& camera, double longest,
               Finished&& finished);
  /// Lets the race choose the size of its pictures by what iterations cost.
  void probe(const IterationContext& context);
  void run_race(const IterationContext& context);
  void run_plan(const IterationContext& context);
  void begin_estimate();
  Plan new_plan() const;
  void make_new_plan();
  void drop(std::size_t k, const std::exception& e, double cost);
  void record_blocks() const;
  void get_plan(ByteReader& in);

  AutoSettings settings_;
  std::vector<Candidate> candidates_;
  Race race_;
  std::optional<Plan> plan_;
  std::shared_ptr<const Verdict> verdict_;  ///< of an earlier race
  std::function<void(const Verdict&)> keep_;
  /// An earlier race decided, perhaps by the pictures of this seed: the numbers are others.
  bool recalled_ = false;
  std::uint64_t estimates_ = 0;        ///< that are finished
  std::vector<PictureHalves> halves_;  // of each candidate, in finished estimates
  std::uint64_t first_ = 0;            ///< iteration that the race was held in
  // Of the estimate in progress: it goes on where it was stopped.
  std::vector<int> done_;
  std::vector<Image> sums_;
  Counters counters_;
  mutable RaceRecord record_;
};

std::string Auto::excluded(std::size_t k, const PrepareContext& context) const {
  if (k > 0 && context.scene.emitters().empty()) return "the scene has no light";
  if (verdict_ != nullptr) {
    const LogRatio& r = (*verdict_)[k];
    const double least = r.value - 2 * r.deviation;
    if (least > std::log(surely_worse)) {
      return fmt::format("an earlier job found at least {:.2g} times the best one's error",
                         std::exp(least));
    }
  }
  const bool chosen = !settings_.candidates.empty();
  const bool space = candidates_[k].integrator->needs().space;
  if (space && !chosen && context.budget_seconds && *context.budget_seconds < worth_an_analysis) {
    return fmt::format("a budget below {:g} s is not worth an analysis of the space",
                       worth_an_analysis);
  }
  return {};
}

void Auto::recall(const PrepareContext& context) {
  if (!remembers() || context.verdicts == nullptr) return;
  keep_ = context.verdicts->keep;
  if (!context.resumes) verdict_ = context.verdicts->find();
  if (verdict_ != nullptr && verdict_->size() != candidates_.size()) verdict_ = nullptr;
  recalled_ = verdict_ != nullptr;
}

void Auto::keep_verdict() const {
  if (!keep_ || recalled_ || candidates_.size() < 2) return;
  const auto counts = [&](std::size_t k) {
    return race_.entrants()[k].trial.estimates() >= worth_keeping;
  };
  const std::size_t best = race_.best();
  if (!counts(best) || !race_.entrants()[best].standing.tail_known.value_or(false)) return;
  Verdict verdict(candidates_.size(), {0, std::numeric_limits<double>::infinity()});
  for (std::size_t k = 0; k < verdict.size(); ++k) {
    const Entrant& e = race_.entrants()[k];
    if (counts(k) && e.standing.error > 0 && std::isfinite(e.standing.over_best.value))
      verdict[k] = e.standing.over_best;
  }
  keep_(verdict);
}

void Auto::prepare(const PrepareContext& context) {
  recall(context);
  RaceLimits limits{.rounds = 3};
  if (!counts_rays() && context.budget_seconds) {
    limits = RaceLimits::of_seconds(*context.budget_seconds);
  }
  const std::vector<IntegratorSettings> all = candidates(settings_);
  std::vector<std::uint8_t> with_bias;
  with_bias.reserve(all.size());
  for (const IntegratorSettings& c : all) with_bias.push_back(biased(c) ? 1 : 0);
  race_ =
      Race(candidates_.size(), context.camera.width(), context.camera.height(), limits, with_bias);
  for (std::size_t k = 0; k < all.size(); ++k) {
    race_.entrants()[k].shares_starts = shares_starts(all[k]);
  }
  halves_.assign(candidates_.size(), PictureHalves(race_.grid()));
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (const std::string why = excluded(k, context); !why.empty()) {
      race_.leave(k, why);
      continue;
    }
    const double start = clock_seconds(CLOCK_MONOTONIC);
    try {
      candidates_[k].integrator->prepare(context);
      candidates_[k].prepared = true;
    } catch (const Stopped&) {
      throw;
    } catch (const WaitInterrupted&) {
      throw;
    } catch (const std::exception& e) {
      drop(k, e, 0);
    }
    candidates_[k].preparation = clock_seconds(CLOCK_MONOTONIC) - start;
  }
}

void Auto::drop(std::size_t k, const std::exception& e, double cost) {
  race_.leave(k, e.what(), cost);
  const auto& all = race_.entrants();
  if (std::none_of(all.begin(), all.end(), [](const Entrant& x) { return x.racing; })) throw;
}

double Auto::render(std::size_t k, const IterationContext& context, SampleNumber sample,
                    Image& image, std::span<const Tile> parts) {
  std::fill(image.pixels.begin(), image.pixels.end(), Rgb(0, 0, 0));
  // Streams of their own: methods that share random numbers are not independent, nor are shards,
  // which begin at different iterations.
  const std::uint64_t seed = context.seed +
                             (k + 1 + candidates_.size() * first_) * 0x9E3779B97F4A7C15 +
                             (recalled_ ? 0xD1B54A32D192ED03 : 0);
  const std::uint64_t iteration = race_.entrants()[k].trial.iterations();
  const double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
  const Counters c = candidates_[k].integrator->iterate({.scene = context.scene,
                                                         .camera = context.camera,
                                                         .pool = context.pool,
                                                         .seed = seed,
                                                         .iteration = iteration,
                                                         .stop = context.stop,
                                                         .parts = parts,
                                                         .sampler = context.sampler,
                                                         .sample = sample},
                                                        image);
  counters_ += c;
  if (counts_rays()) return static_cast<double>(c.rays + c.shadow_rays);
  return (clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start) / context.pool.threads();
}

template <class Finished>
void Auto::attempt(std::size_t k, const IterationContext& context, const Camera& camera,
                   double longest, Finished&& finished) {
  const double start = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
  const auto taken = [&] {
    return (clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start) / context.pool.threads();
  };
  const std::function<bool()> stop = [&] { return context.stop() || taken() > longest; };
  const IterationContext limited{.scene = context.scene,
                                 .camera = camera,
                                 .pool = context.pool,
                                 .seed = context.seed,
                                 .iteration = context.iteration,
                                 .stop = stop,
                                 .sampler = context.sampler};
  SampleNumber sample = SampleNumber::of_iteration(race_.entrants()[k].trial.iterations());
  sample.randomisation += of_the_race;
  try {
    Image image(camera.width(), camera.height());
    const double cost = render(k, limited, sample, image);
    finished(image, cost);
  } catch (const IterationStopped&) {
    if (context.stop()) throw;
    race_.leave(k, "an iteration takes too long for the race", taken());
  } catch (const Stopped&) {
    throw;
  } catch (const std::exception& e) {
    drop(k, e, counts_rays() ? 0 : taken());
  }
}

void Auto::probe(const IterationContext& context) {
  BlockGrid grid = race_.grid();
  while (grid.trial_pixels() > probe_pixels) ++grid.reduction;
  const Camera camera = context.camera.reduced(grid.reduction);
  std::vector<double> costs(candidates_.size());
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (!race_.entrants()[k].racing) continue;
    const double longest = k == 0 ? infinite : race_.limits().cost * longest_first;
    attempt(k, context, camera, longest, [&](const Image&, double cost) { costs[k] = cost; });
  }
  race_.choose_reduction(costs, grid.reduction);
}

void Auto::run_race(const IterationContext& context) {
  if (!counts_rays() && race_.wants_smaller_pictures()) probe(context);
  const Camera camera = context.camera.reduced(race_.reduction());
  while (const auto k = race_.next()) {
    const bool may_be_late = race_.spent() == 0 || counts_rays();
    const bool is_first = race_.entrants()[*k].trial.iterations() == 0;
    const double rest = std::min(race_.limits().cost - race_.spent(),
                                 race_.limits().cost * (is_first ? longest_first : 1));
    attempt(*k, context, camera, may_be_late ? infinite : rest,
            [&](const Image& image, double cost) { race_.finished(*k, image, cost); });
  }
  race_.close();
}

Plan Auto::new_plan() const {
  PlanFreedom freedom{.regions = settings_.regions};
  // One that does not race has no cost before it begins, and estimates should be of equal length.
  if (candidates_.size() > 1) freedom.cost = race_.limits().budget / estimates_of_a_budget;
  for (const Candidate& c : candidates_) {
    const bool adaptive = settings_.sampling == Sampling::adaptive;
    freedom.by_block.push_back(adaptive && c.integrator->renders_parts() ? 1 : 0);
  }
  return make_plan(race_, freedom);
}

void Auto::make_new_plan() {
  plan_ = new_plan();
  begin_estimate();
}

void Auto::begin_estimate() {
  done_.assign(candidates_.size(), 0);
  const BlockGrid& grid = race_.grid();
  sums_.assign(candidates_.size(), Image());
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    if (plan_->iterations[k] > 0) sums_[k] = Image(grid.width, grid.height);
  }
}

void Auto::run_plan(const IterationContext& context) {
  Image image(context.camera.width(), context.camera.height());
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    while (done_[k] < plan_->iterations[k]) {
      Trial& trial = race_.entrants()[k].trial;
      const BlockGrid& grid = race_.grid();
      std::size_t pixels = 0;
      std::vector<Tile> parts;
      SampleNumber sample{half_of(context), 0};
      if (candidates_[k].integrator->renders_parts()) {
        parts = parts_of(*plan_, grid, k, done_[k], halves_[k].drawn(sample.randomisation), pixels);
      } else {
        sample.index = halves_[k].drawn(sample.randomisation)[0] + std::uint64_t(done_[k]);
        pixels = grid.pixels();
      }
      const double cost = render(k, context, sample, image, parts);
      const bool is_first = trial.iterations() == 0;
      if (trial.grid().reduction > 1) trial.restart_whole();
      trial.charge(cost, double(pixels) / double(grid.pixels()));
      // One of an estimate's tells as much of the noise for a part of the time.
      if (done_[k] == 0) trial.add(image);
      for (std::size_t i = 0; i < image.pixels.size(); ++i) sums_[k].pixels[i] += image.pixels[i];
      ++done_[k];
      // Only now it is known how many iterations the budget holds. Their cost alone decides.
      if (is_first) plan_ = new_plan();
    }
  }
}

Counters Auto::iterate(const IterationContext& context, Image& image) {
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    race_.entrants()[k].spreads = context.sampler == Sampler::sobol && candidates_[k].spreads;
  }
  if (!plan_) {
    if (race_.spent() == 0) first_ = context.iteration;
    run_race(context);
    keep_verdict();
    make_new_plan();
  }
  run_plan(context);
  combine(*plan_, race_.grid(), sums_, image);
  const Counters counters = std::exchange(counters_, {});
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    if (plan_->iterations[k] > 0) halves_[k].add(half_of(context), sums_[k], plan_->counts[k]);
  }
  ++estimates_;
  const bool power_of_two = (estimates_ & (estimates_ - 1)) == 0;
  const bool has_a_choice = candidates_.size() > 1 || settings_.sampling == Sampling::adaptive;
  if (estimates_ >= 4 && power_of_two && has_a_choice) {
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      if (const auto found = halves_[k].variances()) race_.observe(k, *found, halves_[k].samples());
    }
    race_.judge();
    make_new_plan();
  } else {
    begin_estimate();
  }
  return counters;
}

const RaceRecord* Auto::race() const {
  record_ = {.rows = race_.rows(),
             .spent = race_.spent(),
             .reduction = race_.reduction(),
             .limit = race_.limits().cost,
             .budget = race_.limits().budget,
             .seconds = !counts_rays()};
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const Entrant& e = race_.entrants()[k];
    record_.candidates.push_back({.name = candidates_[k].name,
                                  .biased = e.biased,
                                  .racing = e.racing,
                                  .reason = e.reason,
                                  .left_in = e.left_in,
                                  .iterations = e.trial.iterations(),
                                  .cost = e.trial.cost(),
                                  .preparation = candidates_[k].preparation,
                                  .share = plan_ ? plan_->iterations[k] : 0,
                                  .standing = e.standing});
  }
  if (!plan_) return &record_;
  record_.error = plan_->error;
  record_.gain = plan_->gain;
  record_blocks();
  return &record_;
}

void Auto::record_blocks() const {
  const BlockGrid& grid = race_.grid();
  record_.block = grid.size;
  record_.across = grid.across;
  for (std::size_t b = 0; plan_->is_adaptive() && b < grid.blocks(); ++b) {
    int n = 0;
    for (const auto& counts : plan_->counts) n += counts.empty() ? 0 : counts[b];
    record_.samples.push_back(n);
  }
  if (plan_->methods() < 2) return;
  for (std::size_t b = 0; b < grid.blocks(); ++b) {
    std::size_t most = 0;
    const auto weight = [&](std::size_t k) {
      return plan_->iterations[k] > 0 ? plan_->weights[k][b] : 0.0F;
    };
    for (std::size_t k = 1; k < candidates_.size(); ++k) {
      if (weight(k) > weight(most)) most = k;
    }
    record_.blocks.push_back(int(most));
  }
}

void Auto::save(ByteWriter& out) const {
  race_.save(out);
  for (const Candidate& c : candidates_) {
    out.put(std::string_view(c.name));
    out.put(c.prepared);
    if (c.prepared) c.integrator->save(out);
  }
  out.put(recalled_);
  out.put(estimates_);
  for (const PictureHalves& h : halves_) h.save(out);
  out.put(first_);
  out.put(counters_);
  out.put(plan_.has_value());
  if (!plan_) return;
  out.put(plan_->iterations);
  for (const auto& n : plan_->counts) out.put(n);
  for (const auto& w : plan_->weights) out.put(w);
  out.put(plan_->error);
  out.put(plan_->gain);
  out.put(done_);
  for (const Image& sum : sums_) put_image(out, sum);
}

void Auto::get_plan(ByteReader& in) {
  const std::size_t n = candidates_.size();
  const std::size_t blocks = race_.grid().blocks();
  plan_->iterations = in.get_vector<int>();
  if (plan_->iterations.size() != n) {
    throw std::runtime_error("saved plan has another number of candidates");
  }
  for (std::size_t k = 0; k < n; ++k) plan_->counts.push_back(in.get_vector<int>());
  for (std::size_t k = 0; k < n; ++k) plan_->weights.push_back(in.get_vector<float>());
  for (std::size_t k = 0; k < n; ++k) {
    if (plan_->iterations[k] == 0) continue;
    const std::vector<int>& counts = plan_->counts[k];
    if (counts.size() != blocks || plan_->weights[k].size() != blocks) {
      throw std::runtime_error("saved plan has another number of blocks");
    }
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    if (*least < 1 || *most != plan_->iterations[k]) {
      throw std::runtime_error("saved plan has blocks without iterations");
    }
    if (!candidates_[k].prepared) {
      throw std::runtime_error("saved plan has a candidate that takes no part now");
    }
  }
  plan_->error = in.get<double>();
  plan_->gain = in.get<double>();
}

void Auto::load(ByteReader& in) {
  race_.load(in);
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    Candidate& c = candidates_[k];
    if (const std::string name = in.get_string(); name != c.name) {
      throw std::runtime_error("saved race has the candidate \"" + name + "\" in place of \"" +
                               c.name + "\"");
    }
    const bool saved = in.get<std::uint8_t>() != 0;
    if (saved != c.prepared && race_.entrants()[k].racing) {
      throw std::runtime_error("saved race has a candidate that takes no part now");
    }
    if (saved) c.integrator->load(in);
  }
  recalled_ = in.get<std::uint8_t>() != 0;
  estimates_ = in.get<std::uint64_t>();
  for (PictureHalves& h : halves_) h.load(in);
  first_ = in.get<std::uint64_t>();
  counters_ = in.get<Counters>();
  if (in.get<std::uint8_t>() == 0) return;
  plan_.emplace();
  get_plan(in);
  begin_estimate();
  done_ = in.get_vector<int>();
  if (done_.size() != candidates_.size()) throw std::runtime_error("saved estimate is not one");
  for (Image& sum : sums_) get_image(in, sum, "estimate");
}

}  // namespace

std::unique_ptr<Integrator> make_auto(const AutoSettings& settings) {
  return std::make_unique<Auto>(settings);
}

}  // namespace lacuna
