#include "renderer/race/plan.h"

#include <algorithm>
#include <cmath>

#include "renderer/race/mixture.h"

namespace lacuna {

namespace {

/// Mixtures must promise this part of the best entrant's error, and a method this share of them.
constexpr double worthwhile_gain = 0.95;
constexpr double least_share = 0.1;
/// The longest estimate of several methods, as a part of the budget.
constexpr double longest_estimate = 1.0 / 24;

struct Mixable {
  std::vector<std::size_t> who;
  std::vector<BlockSums> errors;  ///< of a unit of cost
  std::vector<BlockSums> halves[2];
  std::size_t best = 0;  ///< index in `who`

  void erase(std::size_t i) {
    const auto at = [i](auto& v) { v.erase(v.begin() + std::ptrdiff_t(i)); };
    at(who);
    at(errors);
    at(halves[0]);
    at(halves[1]);
    if (best > i) --best;
  }
};

Mixable mixable(const Race& race) {
  Mixable m;
  for (std::size_t k = 0; k < race.entrants().size(); ++k) {
    const Entrant& e = race.entrants()[k];
    const bool noisy = total(race.variances()[k]) > 0;
    if (!e.racing || !e.trial.has_halves() || !noisy) continue;
    const double cost = e.trial.iteration_cost();
    const auto error = [&](const BlockSums& variances, double factor) {
      BlockSums sums = smoothed(e.trial.grid(), variances);
      for (double& v : sums) v *= cost * factor;
      return sums;
    };
    const BlockSums halves[2] = {e.trial.variances(0), e.trial.variances(1)};
    if (!(total(halves[0]) > 0) || !(total(halves[1]) > 0)) continue;
    // What is foreseen or unexplained is in the variances, not in those of halves.
    const double hidden = total(race.variances()[k]) / total(e.trial.variances());
    if (k == race.best()) m.best = m.who.size();
    m.who.push_back(k);
    m.errors.push_back(error(race.variances()[k], 1));
    for (int h = 0; h < 2; ++h) m.halves[h].push_back(error(halves[h], hidden));
  }
  return m;
}

/// The error of shares and weights from one half in the other half, over the best entrant's.
double gain_between_halves(const Mixable& m) {
  double mixed = 0, alone = 0;
  for (int h = 0; h < 2; ++h) {
    mixed += mixed_error(best_shares(m.halves[h]), m.halves[h], m.halves[1 - h]);
    alone += total(m.halves[1 - h][m.best]);
  }
  return alone > 0 ? mixed / alone : 1;
}

}  // namespace

int Plan::methods() const {
  return int(std::count_if(iterations.begin(), iterations.end(), [](int n) { return n > 0; }));
}

Plan make_plan(const Race& race, double cost, bool regions) {
  Plan plan;
  const std::vector<Entrant>& entrants = race.entrants();
  plan.iterations.assign(entrants.size(), 0);
  plan.weights.resize(entrants.size());
  const std::size_t best = race.best();
  const BlockGrid& grid = entrants[best].trial.grid();
  const double each = entrants[best].trial.iteration_cost();
  plan.iterations[best] = each > 0 ? std::max(1, int(cost / each)) : 1;
  plan.weights[best].assign(grid.blocks(), 1.0F);
  plan.error = entrants[best].standing.error;
  if (!regions) return plan;
  Mixable m = mixable(race);
  if (m.who.size() < 2 || m.who[m.best] != best) return plan;
  std::vector<double> shares = best_shares(m.errors);
  // The rarest leave one by one: an estimate must hold one iteration of each.
  for (;;) {
    const auto least = std::size_t(std::min_element(shares.begin(), shares.end()) - shares.begin());
    if (shares[least] >= least_share || least == m.best || m.who.size() < 2) break;
    m.erase(least);
    shares = best_shares(m.errors);
  }
  if (m.who.size() < 2) return plan;
  const double gain = gain_between_halves(m);
  double length = cost;
  for (std::size_t i = 0; i < m.who.size(); ++i) {
    length = std::max(length, entrants[m.who[i]].trial.iteration_cost() / shares[i]);
  }
  const bool fits = race.limits().budget == 0 || length <= race.limits().budget * longest_estimate;
  if (gain > worthwhile_gain || !fits) return plan;
  plan.gain = gain;
  plan.error = mixed_error(shares, m.errors, m.errors) / double(grid.pixels());
  plan.iterations.assign(entrants.size(), 0);
  plan.weights[best].clear();
  std::vector<double> sums(grid.blocks(), 0.0);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < m.who.size(); ++i) {
      const std::size_t k = m.who[i];
      const double one = entrants[k].trial.iteration_cost();
      const int n = std::max(1, int(std::lround(shares[i] * length / one)));
      plan.iterations[k] = n;
      plan.weights[k].resize(grid.blocks());
      for (std::size_t b = 0; b < sums.size(); ++b) {
        const double precision = n * one / m.errors[i][b];
        if (pass == 0) sums[b] += precision;
        if (pass == 1) plan.weights[k][b] = float(precision / sums[b]);
      }
    }
  }
  return plan;
}

void combine(const Plan& plan, const BlockGrid& grid, const std::vector<Image>& sums, Image& out) {
  const bool alone = plan.methods() == 1;
  for (std::size_t k = 0; k < plan.iterations.size(); ++k) {
    if (plan.iterations[k] == 0) continue;
    const auto n = float(plan.iterations[k]);
    std::size_t i = 0;
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x, ++i) {
        const float weight = alone ? 1.0F : plan.weights[k][grid.block_of(x, y)];
        out.pixels[i] += sums[k].pixels[i] / n * weight;
      }
    }
  }
}

}  // namespace lacuna
