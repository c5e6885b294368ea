#include "renderer/race/race.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "base/storage/bytes.h"
#include "renderer/film/saved_values.h"
#include "renderer/race/mixture.h"

namespace lacuna {

namespace {

/// Standard deviations by which a method must be worse than the best to leave.
constexpr double sure = 2;
/// And, where there is one estimate of each, by which ratio.
constexpr double sure_of_singles = 1.5;
/// By what factor an error is larger than it seems where the tail does not let it be known: one to
/// five were seen.
constexpr double doubt = 2;
/// A method that left comes back where its error is below this part of the best one's: few
/// iterations are no ground for a change.
constexpr double clearly_better = 0.5;
/// How far the logarithms of a ratio of errors and of the typical ratio lie apart where both are
/// known, as a standard deviation: a guess.
constexpr double disagreement = 1;
/// Iterations of each entrant that a race should afford; its pictures are smaller where it cannot:
/// what spread samples gain shows after many.
constexpr double enough_iterations = 16;
/// An entrant leaves if its share of the race is less than so many of the smallest pictures.
constexpr double fewest_iterations = 4;
/// The fewest pixels of its pictures, whatever they cost.
constexpr std::size_t least_pixels = 4096;
/// What even spread may leave of the variance, while it is not known: as little as .004 was seen.
constexpr double least_left = 0.1;
/// A share of the best mixture that keeps a method in the race.
constexpr double worthwhile_share = 0.15;

void put_standing(ByteWriter& out, const Standing& s) {
  out.put(s.error);
  out.put(s.over_best);
  out.put(s.growth);
  out.put(s.spread);
  out.put(s.tail_known.has_value());
  out.put(s.tail_known.value_or(false));
  out.put(s.unexplained);
  out.put(s.bias);
  out.put(s.bias_deviation);
}

Standing get_standing(ByteReader& in) {
  Standing s;
  s.error = in.get<double>();
  s.over_best = in.get<LogRatio>();
  s.growth = in.get<double>();
  s.spread = in.get<double>();
  const bool tail = in.get<std::uint8_t>() != 0;
  const bool known = in.get<std::uint8_t>() != 0;
  if (tail) s.tail_known = known;
  s.unexplained = in.get<std::uint8_t>() != 0;
  s.bias = in.get<double>();
  s.bias_deviation = in.get<double>();
  return s;
}

std::optional<Spread> get_gauged(ByteReader& in) {
  if (in.get<std::uint8_t>() == 0) return std::nullopt;
  const auto s = in.get<Spread>();
  const bool valid = s.left > 0 && s.left <= 1 && s.count >= 1 && s.later >= 0 && s.later <= 1;
  if (!valid || !std::isfinite(s.count)) throw std::runtime_error("saved race is not one");
  return s;
}

/// What is not known to be above 0 counts as its own standard deviation.
void raise_to_deviation(const BlockGrid& grid, BlockSums& sums) {
  const double sum = total(sums);
  const double lack = standard_deviation(grid, sums) - sum;
  if (!(lack > 0)) return;
  for (double& v : sums) v += lack / double(sums.size());
}

}  // namespace

RaceLimits RaceLimits::of_seconds(double seconds) {
  RaceLimits limits;
  limits.cost = 0.12 * std::pow(seconds, 0.6);
  limits.budget = seconds;
  return limits;
}

Race::Race(std::size_t entrants, int width, int height, const RaceLimits& limits,
           const std::vector<std::uint8_t>& biased)
    : limits_(limits),
      grid_(width, height),
      entrants_(entrants, Entrant{.trial = Trial(width, height)}) {
  measured_.assign(entrants, BlockSums(grid_.blocks(), 0.0));
  variances_ = measured_;
  gauges_.assign(entrants, SpreadGauge(width, height));
  for (std::size_t k = 0; k < biased.size(); ++k) entrants_[k].biased = biased[k] != 0;
}

std::size_t Race::racing() const {
  return std::size_t(
      std::count_if(entrants_.begin(), entrants_.end(), [](const Entrant& e) { return e.racing; }));
}

bool Race::wants_smaller_pictures() const {
  const bool begun = spent_ > 0 || probed_ > 0;
  const bool any_biased = std::any_of(entrants_.begin(), entrants_.end(),
                                      [](const Entrant& e) { return e.racing && e.biased; });
  return !begun && racing() > 1 && !any_biased && std::isfinite(limits_.cost);
}

void Race::choose_reduction(std::span<const double> costs, int reduction) {
  BlockGrid grid = grid_;
  grid.reduction = reduction;
  const double pixels = double(grid.trial_pixels());
  probed_ = std::accumulate(costs.begin(), costs.end(), 0.0);
  const double cost = std::max(0.0, limits_.cost - probed_);
  // What is slow in the smallest pictures would take the time of the others.
  double longest = cost / double(racing()) / fewest_iterations, each = 0;
  double cheapest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < costs.size(); ++k) {
    if (entrants_[k].racing) cheapest = std::min(cheapest, costs[k]);
  }
  longest = std::max(longest, cheapest);
  for (std::size_t k = 0; k < costs.size(); ++k) {
    if (!entrants_[k].racing) continue;
    if (costs[k] > longest) {
      leave(k, "an iteration takes too long for the race");
    } else {
      each += costs[k] / pixels * enough_iterations;
    }
  }
  const auto too_long = [&] { return each * double(grid.trial_pixels()) > cost; };
  for (grid.reduction = 1; too_long() && grid.trial_pixels() > least_pixels;) ++grid.reduction;
  reduction_ = grid.reduction;
  for (Entrant& e : entrants_) e.trial = Trial(grid.width, grid.height, reduction_);
  gauges_.assign(entrants_.size(), SpreadGauge(grid.trial_width(), grid.trial_height()));
  limits_.cost = cost;
}

bool Race::in_this_round(const Entrant& e) const {
  if (!e.racing) return false;
  const auto n = e.trial.iterations();
  return round_ == 0 ? n == 0 : n < 2 || e.trial.cost() + e.trial.next_cost() <= slice_;
}

std::optional<std::size_t> Race::next() const {
  const bool first = spent_ == 0;
  if (racing() < 2 || round_ >= limits_.rounds) return std::nullopt;
  if (!first && spent_ >= limits_.cost) return std::nullopt;
  // Those first of which nothing is known, then that which has had the least time.
  std::optional<std::size_t> chosen;
  const auto before = [&](std::size_t a, std::size_t b) {
    const Trial &x = entrants_[a].trial, &y = entrants_[b].trial;
    const auto key = [](const Trial& t) {
      return std::pair(std::min<std::uint64_t>(t.iterations(), 2), t.cost());
    };
    return key(x) < key(y);
  };
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    if (in_this_round(entrants_[k]) && (!chosen || before(k, *chosen))) chosen = k;
  }
  if (chosen && round_ > 0 && spent_ + entrants_[*chosen].trial.next_cost() > limits_.cost) {
    return std::nullopt;
  }
  return chosen;
}

void Race::finished(std::size_t entrant, const Image& estimate, double cost) {
  Entrant& e = entrants_[entrant];
  e.trial.add(estimate);
  if (e.spreads) gauges_[entrant].add(estimate);
  e.trial.charge(cost, e.trial.grid().trial_share());
  spent_ += cost;
  end_round();
}

void Race::leave(std::size_t entrant, const std::string& reason, double cost) {
  Entrant& e = entrants_[entrant];
  e.racing = false;
  e.reason = reason;
  e.left_in = round_;
  spent_ += cost;
  end_round();
}

void Race::end_round() {
  const bool more = std::any_of(entrants_.begin(), entrants_.end(),
                                [&](const Entrant& e) { return in_this_round(e); });
  if (more) return;
  judge();
  drop_losers();
  ++round_;
  // Equal costs, in which the slowest has one more iteration; then twice as much each time.
  double longest = 0;
  for (const Entrant& e : entrants_) {
    if (e.racing) longest = std::max(longest, e.trial.next_cost());
  }
  slice_ = std::max(2 * slice_, 2 * longest);
}

void Race::close() {
  for (Entrant& e : entrants_) {
    if (!e.racing || e.trial.iterations() > 0 || racing() < 2) continue;
    e.racing = false;
    e.left_in = round_;
    e.reason = "the race had no time left for it";
  }
  judge();
  gauges_.clear();
  spent_ += std::exchange(probed_, 0);
}

double Race::log_cost_ratio(std::size_t a, std::size_t b) const {
  const double x = entrants_[a].trial.iteration_cost(), y = entrants_[b].trial.iteration_cost();
  return x > 0 && y > 0 ? std::log(x / y) : 0;
}

LogRatio Race::ratio(std::size_t a, std::size_t b) const {
  LogRatio r = log_ratio(entrants_[a].trial.grid(), variances_[a], variances_[b]);
  r.value += log_cost_ratio(a, b);
  return r;
}

double Race::likely_ratio(std::size_t a, std::size_t b) const {
  const LogRatio r = ratio(a, b);
  const auto typical = typical_log_ratio(measured_[a], measured_[b]);
  if (!typical || !(r.deviation > 0)) return r.value;
  const double z = r.deviation / disagreement;
  const auto foreseen = [&](std::size_t k) {
    return std::log(entrants_[k].standing.spread * of_whole_pictures(k));
  };
  const double other = *typical + log_cost_ratio(a, b) + foreseen(a) - foreseen(b);
  return std::isfinite(r.value) && std::isfinite(z) ? other + (r.value - other) / (1 + z * z)
                                                    : other;
}

bool Race::is_known(std::size_t which) const {
  const Trial& t = entrants_[which].trial;
  return t.estimates() > 1 || (t.estimates() == 1 && total(measured_[which]) > 0);
}

std::size_t Race::best_of(bool biased) const {
  std::size_t best = entrants_.size();
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    if (!entrants_[k].racing || (entrants_[k].biased && !biased)) continue;
    if (best == entrants_.size() ||
        (is_known(k) && (!is_known(best) || likely_ratio(k, best) < 0))) {
      best = k;
    }
  }
  return best;
}

std::size_t Race::yardstick() const {
  const bool needed = std::any_of(entrants_.begin(), entrants_.end(),
                                  [](const Entrant& e) { return e.racing && e.biased; });
  return needed ? best_of(false) : entrants_.size();
}

void Race::estimate_variances() {
  std::vector<std::size_t> single;
  std::vector<const Image*> pictures;
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    if (!entrants_[k].racing || entrants_[k].trial.estimates() == 0) continue;
    if (entrants_[k].trial.estimates() == 1) {
      single.push_back(k);
      pictures.push_back(&entrants_[k].trial.mean());
    } else {
      measured_[k] = entrants_[k].trial.variances();
    }
  }
  // Later singles keep what the first round found.
  if (round_ > 0 || single.size() < 3) return;
  const auto found = variances_of_singles(entrants_[single[0]].trial.grid(), pictures);
  for (std::size_t i = 0; i < single.size(); ++i) {
    measured_[single[i]] = found[i];
    raise_to_deviation(entrants_[single[i]].trial.grid(), measured_[single[i]]);
  }
}

double Race::rest(const Trial& trial) const {
  return limits_.budget > 0 ? std::max(0.0, limits_.budget - spent_) : 16 * trial.cost();
}

/// The noise of Metropolis' starts falls with the number of pixels: of an iteration of 85 x 48
/// pixels the variance is 1.6 to 2.4 times that of 256 x 144 where light is easy, 4.6 on door, 23
/// and 27 on ajar and corridor. The root of the ratio of pixels is 3.
double Race::of_whole_pictures(std::size_t which) const {
  const Entrant& e = entrants_[which];
  return e.shares_starts ? 1 / double(e.trial.grid().reduction) : 1;
}

double Race::foreseen_spread(std::size_t which) const {
  const Entrant& e = entrants_[which];
  const double cost = e.trial.iteration_cost();
  return e.gauged && cost > 0 ? e.gauged->left_of(rest(e.trial) / cost) : 1;
}

void Race::observe(std::size_t entrant, const BlockSums& variances, double samples) {
  Entrant& e = entrants_[entrant];
  const double independent = total(measured_[entrant]), found = total(variances);
  if (!(independent > 0) || !(found > 0)) return;
  const bool again = !e.observed.empty();
  Spread now = Spread::of(found / independent, samples);
  if (again) now.steepen(total(e.observed), e.gauged->count, found);
  e.observed = variances;
  e.gauged = now;
}

double Race::foreseen_growth(std::size_t which) const {
  const Trial& t = entrants_[which].trial;
  const double cost = t.next_cost();
  const double growth = cost > 0 ? t.growth(rest(t) / cost) : 1;
  return t.tail_is_known().value_or(true) ? growth : doubt * growth;
}

void Race::judge_alone(std::size_t which, const BlockSums& hidden, double growth) {
  Entrant& e = entrants_[which];
  Standing& s = e.standing;
  variances_[which] = e.observed.empty() ? measured_[which] : e.observed;
  // Differences of singles are in their variances already.
  s.unexplained = !e.biased && e.trial.estimates() > 1 &&
                  total(hidden) > 3 * standard_deviation(e.trial.grid(), hidden);
  for (std::size_t b = 0; s.unexplained && b < hidden.size(); ++b) {
    variances_[which][b] += std::max(0.0, hidden[b]) * double(e.trial.estimates());
  }
  s.growth = growth;
  s.tail_known = e.trial.tail_is_known();
  if (!gauges_.empty() && e.observed.empty()) {
    e.gauged = gauges_[which].spread(total(measured_[which]) * e.trial.grid().trial_share());
  }
  s.spread = foreseen_spread(which);
  // What was observed has all of that but what is still to come.
  const double seen = e.observed.empty() ? 1 : e.gauged->left;
  const double factor = growth * s.spread / seen * of_whole_pictures(which);
  for (double& v : variances_[which]) v *= factor;
  if (e.biased && e.trial.estimates() > 1) count_bias(which, hidden);
  s.error = std::max(0.0, total(variances_[which])) * e.trial.iteration_cost() /
            double(e.trial.grid().pixels());
}

BlockSums Race::hidden_error(std::size_t which) const {
  const Trial nothing;
  std::vector<const Trial*> trials;
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    trials.push_back(entrants_[k].biased && k != which ? &nothing : &entrants_[k].trial);
  }
  return unexplained_error(trials, measured_, which);
}

void Race::count_bias(std::size_t which, const BlockSums& hidden) {
  Entrant& e = entrants_[which];
  const double sum = total(hidden), deviation = standard_deviation(e.trial.grid(), hidden);
  const auto pixels = double(e.trial.grid().pixels());
  e.standing.bias = std::max(0.0, sum) / pixels;
  e.standing.bias_deviation = deviation / pixels;
  const double iterations = rest(e.trial) / std::max(1e-12, e.trial.iteration_cost());
  // A bias that is not seen may still be as large as what would hide it.
  const double counted = std::max(sum, deviation) * iterations;
  BlockSums positive = hidden;
  for (double& v : positive) v = std::max(0.0, v);
  const double all = total(positive);
  for (std::size_t b = 0; b < positive.size(); ++b) {
    const double part = sum > deviation ? positive[b] / all : 1 / double(positive.size());
    variances_[which][b] += part * counted;
  }
}

void Race::judge() {
  estimate_variances();
  double most = 1;
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    if (entrants_[k].racing) most = std::max(most, foreseen_growth(k));
  }
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    const Entrant& e = entrants_[k];
    if (!e.racing || !is_known(k)) continue;
    const bool known = e.trial.tail_is_known().has_value();
    judge_alone(k, hidden_error(k), known ? foreseen_growth(k) : most);
  }
  call_back(most);
  const std::size_t leader = best();
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    Entrant& e = entrants_[k];
    if (!e.racing || !is_known(k)) continue;
    const LogRatio r = e.standing.over_best = ratio(k, leader);
    rows_.push_back({round_, std::uint32_t(k), e.trial.iterations(), e.trial.cost(),
                     e.standing.error, r.value, r.deviation});
  }
}

void Race::call_back(double growth) {
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    Entrant& e = entrants_[k];
    if (!e.beaten) continue;
    // It left with few iterations, which show no tail.
    const double more = std::log(std::max(1.0, growth / e.standing.growth));
    if (!(likely_ratio(k, best()) + more < std::log(clearly_better))) continue;
    e.racing = true;
    e.beaten = false;
  }
}

double Race::unknown_gain(std::size_t which) const {
  const Entrant& e = entrants_[which];
  const bool unknown = !e.gauged && e.spreads && e.trial.iteration_cost() > 0;
  return unknown ? -std::log(least_left) : 0;
}

bool Race::is_beaten(std::size_t which) const {
  const double least = round_ == 0 ? std::log(sure_of_singles) : 0;
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    if (!entrants_[k].racing || k == which || !is_known(k)) continue;
    const LogRatio r = ratio(which, k);
    if (r.value - sure * r.deviation > least + unknown_gain(which)) return true;
  }
  return false;
}

void Race::drop_losers() {
  const bool of_singles = round_ == 0;
  // Two estimates do not say whose noise it is; and where smaller pictures leave time for more than
  // one of each, one is no ground: it may have missed all bright paths.
  if (of_singles && (racing() == 2 || probed_ > 0)) return;
  const std::size_t leader = best(), measure = yardstick();
  std::vector<std::size_t> who;
  std::vector<BlockSums> errors;
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    if (!entrants_[k].racing || !is_known(k)) continue;
    who.push_back(k);
    errors.push_back(smoothed(entrants_[k].trial.grid(), variances_[k]));
    for (double& v : errors.back()) v *= entrants_[k].trial.iteration_cost();
  }
  if (who.empty()) return;
  const bool without_noise =
      entrants_[leader].trial.estimates() > 1 && !(total(variances_[leader]) > 0);
  Shares shares;
  if (!without_noise) shares = best_shares(errors);
  std::vector<std::size_t> losers;
  for (std::size_t i = 0; i < who.size(); ++i) {
    const bool useful = !of_singles && !without_noise && share_of(shares[i]) >= worthwhile_share;
    if (who[i] == leader || who[i] == measure || (!without_noise && (useful || !is_beaten(who[i]))))
      continue;
    losers.push_back(who[i]);
  }
  for (const std::size_t k : losers) {
    Entrant& e = entrants_[k];
    e.racing = false;
    e.beaten = true;
    e.left_in = round_;
    e.reason = without_noise ? "another has no noise" : "worse than another";
  }
}

void Race::save(ByteWriter& out) const {
  out.put(reduction_);
  out.put(probed_);
  out.put(spent_);
  out.put(round_);
  out.put(slice_);
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    const Entrant& e = entrants_[k];
    out.put(e.racing);
    out.put(e.beaten);
    out.put(std::string_view(e.reason));
    out.put(e.left_in);
    put_standing(out, e.standing);
    e.trial.save(out);
    out.put(e.gauged.has_value());
    if (e.gauged) out.put(*e.gauged);
    out.put(e.observed);
    out.put(measured_[k]);
    out.put(variances_[k]);
  }
  out.put(!gauges_.empty());
  for (const SpreadGauge& g : gauges_) g.save(out);
  out.put(rows_);
}

void Race::load(ByteReader& in) {
  reduction_ = in.get<int>();
  probed_ = in.get<double>();
  spent_ = in.get<double>();
  round_ = in.get<int>();
  slice_ = in.get<double>();
  for (std::size_t k = 0; k < entrants_.size(); ++k) {
    Entrant& e = entrants_[k];
    e.racing = in.get<std::uint8_t>() != 0;
    e.beaten = in.get<std::uint8_t>() != 0;
    e.reason = in.get_string();
    e.left_in = in.get<int>();
    e.standing = get_standing(in);
    e.trial.load(in);
    e.gauged = get_gauged(in);
    e.observed = in.get_vector<double>();
    const std::size_t seen = e.observed.size();
    if ((seen != 0 && seen != e.trial.grid().blocks()) || (seen != 0 && !e.gauged)) {
      throw std::runtime_error("saved race is not one");
    }
    measured_[k] = get_finite(in, e.trial.grid().blocks(), "variances of blocks");
    variances_[k] = get_finite(in, e.trial.grid().blocks(), "variances of blocks");
  }
  BlockGrid grid = grid_;
  if (reduction_ < 1 || reduction_ > std::max(grid.width, grid.height) || !(probed_ >= 0)) {
    throw std::runtime_error("saved race is not one");
  }
  grid.reduction = reduction_;
  gauges_.clear();
  if (in.get<std::uint8_t>() != 0) {
    gauges_.assign(entrants_.size(), SpreadGauge(grid.trial_width(), grid.trial_height()));
  }
  for (SpreadGauge& g : gauges_) g.load(in);
  rows_ = in.get_vector<RaceRow>();
  for (const RaceRow& r : rows_) {
    if (r.entrant >= entrants_.size()) throw std::runtime_error("saved race has another entrant");
  }
  if (!(spent_ >= 0) || !(slice_ >= 0) || racing() == 0) {
    throw std::runtime_error("saved race is not one");
  }
}

}  // namespace lacuna
