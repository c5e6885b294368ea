#include "renderer/guides/tuning.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace lacuna {

namespace {

/// The values of a cell that has not learned yet: the strength of the thesis, and half of its
/// probability, because the first iterations count like all others, and a wrong guide spoils them.
constexpr float first_strength = 8, first_probability = 0.25F;
/// Paths below which a cell keeps its initial values.
constexpr double min_paths = 8;
/// Time of a vertex with a guide over one without; measured 1.2 to 1.6, learning included.
constexpr double guided_cost = 1.4;
/// The same of an iteration, learning included: 1.4 to 2 with lobes and learned directions on five
/// scenes, 2.1 to 3.2 on atrium.
constexpr double guided_iteration_cost = 1.75;
/// A guide that seems to pay so many times needs no comparison; twice as many where that is not
/// known.
constexpr double surely_pays = 2;
/// Nor does one that is known to promise no more than this part of the noise.
constexpr double promises_nothing = 0.1;
/// Pilots are of a sixteenth of the picture each. So many are made before the first iteration, and
/// more where they do not decide, of which the first follow the BSDF: what vertices gather behind
/// them is known after one, and directions that were learned from it are judged by the next two.
constexpr std::uint64_t first_pilots = 16, most_first_pilots = 32, plain_pilots = 3;
/// And so many of all: a scene of which they say nothing keeps its guide. Pilots take time from
/// dark pictures: with 96, one to five iterations of 30 in 8 seconds.
constexpr std::uint64_t most_pilots = 40;
/// Deviations that the ratio of two noises must differ from 1 by; and where so few bright paths
/// make it that its deviation is large.
constexpr double decisive = 2, decisive_of_unknown = 3;
/// What the logarithm of the gain of directions that are learned is expected to grow by with each
/// doubling of the iterations, and until when: on door and bends by .6 from the first to the 128th.
/// Half of it is counted, because until then each iteration may lose.
constexpr double grows_by = 0.05, grows_until = 256;
/// Without pilots, one of so many iterations at most follows the BSDF for comparison.
constexpr std::uint64_t rests_of = 16;
/// The relative deviation of the ratio of two noises up to which it is known well enough; above, it
/// must differ from 1 by as much.
constexpr double comparable = 0.25;
/// Pairs of pixels that tell anything of a noise: few meet no bright path. And those of an
/// iteration below which a picture is too small for that.
constexpr double least_pairs = 16384, least_pairs_of_one = 1024;
/// Iterations before the first that follows the BSDF: the guide begins to learn.
constexpr std::uint64_t before_rests = 3;
/// A sum of squares is known if its largest term has at most this share.
constexpr double known_share = 0.05;
/// In dark pictures the BSDF finds light in at most this share of the pairs of pixels: .17 and .03
/// in two views of sponza, .14 on door, .07 on bends, one in 10,000 on corridor. Their cells wait
/// for bright paths.
constexpr double dark_share = 0.25;
/// Iterations before the noise of a dark picture is known: on sponza 32 pilots told that the guide
/// doubles it, 16 iterations that it takes three quarters of it away.
constexpr std::uint64_t patient_until = 16;
/// The probability of a cell whose moments are not known, and the least in the dark: moments know
/// nothing of light that has not been found yet.
constexpr float careful_probability = 0.5F;
/// Paths of all cells from which a guide may be left alone, and where moments alone decide: an end
/// is final, and at 16384 one of 12 pictures of bends ended a guide that pays, at 32768 none of
/// 144. And the largest share of one path.
constexpr double least_paths = 16384, least_paths_of_small = 32768, known_share_of_all = 0.02;
/// Largest square over the mean of those that are not 0, below which spread samples
/// (Sampler::sobol) of the BSDF do better than any guide: 2 on a scene where guides quadruple the
/// error (area), 200 to 5000 on others.
constexpr double smooth_peak = 16, least_smooth_paths = 1024;

/// Whether surely fewer pairs of pixels are lit with the guide than without, by more than `growth`
/// of the logarithm.
bool finds_less_light(const Tuning::Noise& with, const Tuning::Noise& without, double growth) {
  const double share = without.lit / without.pairs;
  const double variance = share * (1 - share) * (1 / with.pairs + 1 / without.pairs);
  return share * std::exp(-growth) - with.lit / with.pairs > decisive * std::sqrt(variance);
}

/// Logarithm of how many times as many pairs are lit with the guide as without: the smallest that
/// is likely. Requires lit pairs without it.
double least_log_lit_ratio(const Tuning::Noise& with, const Tuning::Noise& without) {
  const double ratio = std::log(with.lit / with.pairs / (without.lit / without.pairs));
  return ratio - decisive * std::sqrt(1 / with.lit + 1 / without.lit);
}

std::uint32_t nearest(const std::vector<float>& values, float wanted) {
  const auto closer = [wanted](float a, float b) {
    return std::abs(a - wanted) < std::abs(b - wanted);
  };
  return static_cast<std::uint32_t>(std::min_element(values.begin(), values.end(), closer) -
                                    values.begin());
}

}  // namespace

void Tuning::Noise::add(const Noise& other) {
  sum += other.sum;
  squares += other.squares;
  pairs += other.pairs;
  lit += other.lit;
  by_bsdf += other.by_bsdf;
  by_bsdf_squares += other.by_bsdf_squares;
  products += other.products;
}

void Tuning::Noise::fade(double share) {
  for (double* v : {&sum, &squares, &pairs, &lit, &by_bsdf, &by_bsdf_squares, &products}) {
    *v *= share;
  }
}

double Tuning::Noise::log_gain_deviation() const {
  const double own = doubt(), other = by_bsdf_squares / (by_bsdf * by_bsdf);
  const double linear = other + own - 2 * products / (by_bsdf * sum);
  return std::sqrt(std::max({linear, own, other}));
}

Tuning::Tuning(std::vector<float> strengths, const AutoNumber& probability, std::size_t cells,
               Directions directions)
    : strengths_(std::move(strengths)), directions_(directions) {
  if (probability.is_auto()) {
    probabilities_ = {0, 0.125F, 0.25F, 0.375F, 0.5F, 0.625F, 0.75F, 0.875F};
  } else {
    probabilities_ = {static_cast<float>(*probability.value)};
  }
  for (const float s : strengths_) {
    for (const float c : probabilities_) choices_.push_back({s, c});
  }
  const std::uint32_t first =
      nearest(strengths_, first_strength) * static_cast<std::uint32_t>(count()) +
      nearest(probabilities_, first_probability);
  chosen_.assign(cells, first);
  if (learns()) moments_.assign(cells * stride(), 0.0);
}

void Tuning::accumulate(const GuidingSample& sample, std::uint32_t cell,
                        std::span<const float> densities, Accumulator& accumulator) const {
  const Vertex& v = sample.v;
  const double energy = double(sample.pixel_contribution) * double(sample.pixel_contribution) *
                        double(sample.pdf.value);
  if (!(energy > 0) || !std::isfinite(energy)) return;
  const float bsdf = v.bsdf->pdf(v.wp, sample.wi, Transport::radiance).value;
  std::vector<double>& moments = accumulator.moments[cell];
  moments.resize(stride());
  std::size_t i = 0;
  for (const float density : densities) {
    for (const float c : probabilities_) {
      moments[i++] += energy / double(c * density + (1 - c) * bsdf);
    }
  }
  moments[i] = std::max(moments[i], energy / double(sample.pdf.value));
  moments[i + 1] += 1;
}

void Tuning::update(std::span<const Accumulator* const> accumulators, double iterations) {
  std::vector<char> met(chosen_.size(), 0);
  Noise noise;
  for (const Accumulator* t : accumulators) {
    noise.add(t->noise);
    for (const auto& [cell, moments] : t->moments) {
      met[cell] = 1;
      double* const all = moments_.data() + cell * stride();
      for (std::size_t i = 0; i < stride(); ++i) {
        all[i] = i == candidates() ? std::max(all[i], moments[i]) : all[i] + moments[i];
      }
    }
  }
  for (std::size_t cell = 0; cell < met.size(); ++cell) {
    if (met[cell] != 0) choose(cell);
  }
  const bool plain = follows_bsdf();
  pairs_ = noise.pairs / iterations;
  if (std::exchange(in_pilot_, false)) {
    ++pilots_;
    (plain ? without_ : with_).add(noise);
    if (!plain) noise_ += noise.sum;
    if (iterations_ == 0) judge_pilots();
    return;
  }
  ++iterations_;
  if (std::exchange(rests_, false)) {
    ++rested_;
    without_.add(noise);
    compare();
    return;
  }
  noise_ += noise.sum;
  with_.add(noise);
  if (!std::has_single_bit(iterations_)) return;
  if (pilots_ > 0) judge_pilots();
  with_.fade(0.25);  // what the guide did long ago counts little
}

std::optional<std::uint64_t> Tuning::due_pilot() const {
  if (idle_ || !learns() || probabilities_.front() > 0) return std::nullopt;
  // The first tells how large the picture is.
  const bool small = pilots_ > 0 && pairs_ < least_pairs_of_one;
  const bool first = iterations_ == 0 && !small && pilots_ < most_first_pilots;
  // Later ones take as many sixteenths of an iteration as there were iterations, at most.
  const bool later = iterations_ > 0 && pilots_ > 0 && !small &&
                     pilots_ < std::min(most_first_pilots + iterations_, most_pilots);
  return !pays_ && (first || later) ? std::optional(pilots_) : std::nullopt;
}

bool Tuning::pilot_is_guided() const {
  return iterations_ == 0 && pilots_ >= plain_pilots && pilots_ % 2 != 0;
}

double Tuning::hoped() const {
  if (directions_ == Directions::fixed) return 0;
  const double doublings = std::log2(grows_until / double(std::max<std::uint64_t>(iterations_, 1)));
  return grows_by * std::max(doublings, 0.0);
}

double Tuning::log_gain_that_pays() const { return std::log(guided_iteration_cost) - hoped(); }

bool Tuning::is_dark() const { return finds_light_in_at_most(dark_share); }

/// Bright paths that have not come yet make most of the noise of a dark picture, but how often
/// light is found is known.
bool Tuning::noise_comes_later() const { return iterations_ < patient_until && is_dark(); }

/// Lobes that are not learned must find far more of it: with twice as much
/// the skeleton's lost to the BSDF on ajar and door.
bool Tuning::begins_in_the_dark() const {
  const double margin = directions_ == Directions::fixed ? std::log(surely_pays) : 0;
  return noise_comes_later() && without_.lit > 0 &&
         least_log_lit_ratio(with_, without_) > log_gain_that_pays() + margin;
}

/// Where the BSDF finds few bright paths, how often light is found tells more than its noise.
/// Directions that are learned come to find it more often: all pilots tell, or in the dark later
/// iterations.
bool Tuning::finds_too_little_light() const {
  const bool unknown = without_.doubt() >= comparable * comparable;
  if (directions_ == Directions::fixed) return unknown && finds_less_light(with_, without_, 0);
  const bool early = iterations_ == 0 && pilots_ < most_first_pilots;
  return unknown && !early && !noise_comes_later() && finds_less_light(with_, without_, grows_by);
}

void Tuning::judge_pilots() {
  if (pilots_ < first_pilots || pairs_ < least_pairs_of_one) return;
  // One iteration with the guide would keep the error of spread samples up for long.
  if (sums().smooth() || finds_too_little_light()) {
    idle_ = true;
    return;
  }
  if (begins_in_the_dark()) {
    pays_ = true;
    return;
  }
  if (!(with_.sum > 0) || !(with_.by_bsdf > 0)) return;
  const double gain = with_.log_gain() - log_gain_that_pays();
  const double deviation = with_.log_gain_deviation();
  const bool known = deviation < comparable;
  const double wanted = (known ? decisive : decisive_of_unknown) * deviation;
  const bool last = iterations_ == 0 && pilots_ == most_first_pilots;
  const bool shown = std::abs(gain) > wanted;
  if (!shown && !(last && (!finds_light_in_at_most(0.5) || known))) return;
  idle_ = gain < 0 || !(shown || known);
  pays_ = !idle_;
}

void Tuning::compare() {
  if (without_.pairs < least_pairs || !(with_.sum > 0) || !(without_.sum > 0)) return;
  const double gain = std::log(without_.mean() / (with_.mean() * guided_iteration_cost));
  const double deviation = std::sqrt(with_.doubt() + without_.doubt());
  if (deviation > comparable && std::abs(gain) < deviation) return;
  idle_ = gain < 0;
  decided_ = 0;
  for (std::size_t cell = 0; cell < chosen_.size(); ++cell) decided_ += paths(cell);
}

double Tuning::moment(std::size_t cell, std::size_t candidate) const {
  const double* const moments = moments_.data() + cell * stride();
  const double unseen = moments[candidates()] / (1 - double(choices_[candidate].probability));
  return moments[candidate] + unseen;
}

double Tuning::expense(std::size_t cell, std::size_t candidate) const {
  const bool guided = choices_[candidate].probability > 0;
  return moment(cell, candidate) * (guided ? guided_cost : 1.0);
}

std::uint32_t Tuning::cheapest(std::size_t cell) const {
  const float least_probability = is_dark() ? careful_probability : 0;
  double least = HUGE_VAL;
  std::uint32_t best = 0;
  for (std::uint32_t i = 0; i < candidates(); ++i) {
    const double value = expense(cell, i);
    if (value >= least || choices_[i].probability < least_probability) continue;
    least = value;
    best = i;
  }
  return best;
}

/// Where one path makes most of the moment: the guide with a middling probability, if it would have
/// been better than the BSDF so far, or the BSDF hardly finds light. There rare bright paths may
/// not have come yet, and would count in full where it was chosen.
std::uint32_t Tuning::carefully(std::size_t cell) const {
  const double* const moments = moments_.data() + cell * stride();
  const auto middling = nearest(probabilities_, careful_probability);
  std::uint32_t best = middling;
  for (std::uint32_t i = middling; i < candidates(); i += static_cast<std::uint32_t>(count())) {
    if (moments[i] <= moments[best]) best = i;
  }
  return is_dark() || moments[best] < moments[0] ? best : 0;
}

void Tuning::choose(std::size_t cell) {
  if (paths(cell) < min_paths) return;
  const double* const moments = moments_.data() + cell * stride();
  const bool known = moments[candidates()] < known_share * moments[0];
  const bool can_be_zero = probabilities_.front() == 0;
  chosen_[cell] = known || !can_be_zero ? cheapest(cell) : carefully(cell);
}

Tuning::Sums Tuning::sums() const {
  Sums of;
  for (std::size_t cell = 0; cell < chosen_.size(); ++cell) {
    of.plain += moment(cell, 0);
    of.chosen += moment(cell, chosen_[cell]);
    of.largest = std::max(of.largest, moments_[cell * stride() + candidates()]);
    of.paths += paths(cell);
  }
  return of;
}

bool Tuning::Sums::smooth() const {
  return paths >= least_smooth_paths && largest * paths < smooth_peak * plain;
}

void Tuning::stop_if_useless() {
  if (idle_ || !learns() || probabilities_.front() > 0) return;
  const Sums of = sums();
  if (of.smooth()) {
    idle_ = true;
    return;
  }
  if (pilots_ > 0 && pairs_ >= least_pairs_of_one) return;  // they decide
  // Decided at each doubling only: of many decisions by chance one would be wrong.
  const bool small = pairs_ < least_pairs_of_one;
  if (of.paths < std::max(small ? least_paths_of_small : least_paths, 2 * decided_)) return;
  // The noise was measured with the guide: without it, it would be that and the gain.
  const double noise = noise_ > 0 ? noise_ : of.chosen, gain = of.plain - of.chosen;
  const bool known = of.largest < known_share_of_all * of.plain;
  if (small) {
    if (!known) return;
    // Gains multiply along a path: what is measured (bends: 2.2 to 3) is at least the square of
    // what moments promise (1.35).
    const double promised = 1 + gain / noise;
    idle_ = guided_cost > promised * promised;
    decided_ = of.paths;
  } else if (noise + gain > noise * guided_iteration_cost * (known ? 1 : 2) * surely_pays) {
    decided_ = of.paths;
  } else if (known && gain < promises_nothing * noise) {
    idle_ = true;
  } else {
    rests_ = iterations_ >= before_rests && rested_ * rests_of < iterations_;
  }
}

void Tuning::divide(std::size_t cell) {
  chosen_.push_back(chosen_[cell]);
  if (!learns()) return;
  const std::size_t from = cell * stride();
  for (std::size_t i = 0; i < stride(); ++i) moments_.push_back(moments_[from + i]);
}

void Tuning::fade(double share) {
  for (double& m : moments_) m *= share;
  noise_ *= share;
  decided_ *= share;
}

void Tuning::load(ByteReader& in) {
  if (!learns()) return;
  std::vector<std::uint32_t> chosen = in.get_vector<std::uint32_t>();
  std::vector<double> moments = in.get_vector<double>();
  const auto noise = in.get<double>(), decided = in.get<double>();
  const auto with = in.get<Noise>(), without = in.get<Noise>();
  const auto pairs = in.get<double>();
  const auto iterations = in.get<std::uint64_t>(), rested = in.get<std::uint64_t>();
  const auto pilots = in.get<std::uint64_t>();
  const bool pays = in.get<std::uint8_t>() != 0;
  const bool rests = in.get<std::uint8_t>() != 0;
  const bool idle = in.get<std::uint8_t>() != 0;
  const bool valid = std::all_of(chosen.begin(), chosen.end(),
                                 [this](std::uint32_t i) { return i < candidates(); });
  if (!valid || !(noise >= 0) || !(decided >= 0) || !(with.sum >= 0) || !(without.sum >= 0) ||
      chosen.size() != chosen_.size() || moments.size() != moments_.size()) {
    throw std::runtime_error("saved strengths belong to another scene");
  }
  chosen_ = std::move(chosen);
  moments_ = std::move(moments);
  noise_ = noise;
  decided_ = decided;
  with_ = with;
  without_ = without;
  pairs_ = pairs;
  iterations_ = iterations;
  rested_ = rested;
  pilots_ = pilots;
  pays_ = pays;
  rests_ = rests;
  idle_ = idle;
}

std::vector<std::pair<std::string, double>> Tuning::statistics() const {
  if (!learns()) return {};
  std::size_t learned = 0;
  double logs = 0, shares = 0;
  for (std::size_t cell = 0; cell < chosen_.size(); ++cell) {
    if (paths(cell) < min_paths) continue;
    ++learned;
    logs += std::log2(double(strength(cell)) + 1e-9);
    shares += double(probability(cell));
  }
  const auto n = static_cast<double>(std::max<std::size_t>(learned, 1));
  return {{"places_learned", static_cast<double>(learned)},
          {"mean_strength", std::exp2(logs / n)},
          {"mean_probability", shares / n},
          {"pilots", static_cast<double>(pilots_)}};
}

}  // namespace lacuna
