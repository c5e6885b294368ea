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
/// Iterations of an estimate that suffice to give some blocks more of them than others.
constexpr int least_to_adapt = 8;

struct Mixable {
  std::vector<std::size_t> who;
  std::vector<BlockSums> errors;  ///< of a unit of cost
  std::vector<BlockSums> halves[2];
  std::vector<std::uint8_t> by_block;
  std::size_t best = 0;  ///< index in `who`

  void erase(std::size_t i) {
    const auto at = [i](auto& v) { v.erase(v.begin() + std::ptrdiff_t(i)); };
    at(who);
    at(errors);
    at(halves[0]);
    at(halves[1]);
    at(by_block);
    if (best > i) --best;
  }
};

/// `adapts`: those that may have more iterations in some blocks.
Mixable mixable(const Race& race, const PlanFreedom& freedom, bool adapts) {
  Mixable m;
  for (std::size_t k = 0; k < race.entrants().size(); ++k) {
    const Entrant& e = race.entrants()[k];
    const bool noisy = total(race.variances()[k]) > 0;
    if (!e.racing || e.biased || !e.trial.has_halves() || !noisy) continue;
    // Bright paths that are still to come may come in any block.
    if (k != race.best() && !e.standing.tail_known.value_or(true)) continue;
    if (!freedom.regions && k != race.best()) continue;
    const double cost = e.trial.iteration_cost();
    const BlockGrid& grid = e.trial.grid();
    const BlockSums halves[2] = {e.trial.variances(0), e.trial.variances(1)};
    if (!(total(halves[0]) > 0) || !(total(halves[1]) > 0)) continue;
    if (k == race.best()) m.best = m.who.size();
    m.who.push_back(k);
    // Where spread samples err is not where one errs: that must have been seen.
    const bool seen = !e.spreads || !e.observed.empty();
    m.by_block.push_back(adapts && seen ? freedom.by_block[k] : 0);
    const BlockSums one = smoothed(grid, e.trial.variances());
    BlockSums all = smoothed(grid, race.variances()[k]);
    for (double& v : all) v *= cost;
    for (int h = 0; h < 2; ++h) {
      // What is foreseen, observed or unexplained is in the variances, not in those of halves.
      m.halves[h].push_back(smoothed(grid, halves[h]));
      for (std::size_t b = 0; b < one.size(); ++b) m.halves[h].back()[b] *= all[b] / one[b];
    }
    m.errors.push_back(std::move(all));
  }
  return m;
}

/// The error of shares and weights from one half in the other half, over the best entrant's.
double gain_between_halves(const Mixable& m) {
  double mixed = 0, alone = 0;
  for (int h = 0; h < 2; ++h) {
    mixed += mixed_error(best_shares(m.halves[h], m.by_block), m.halves[h], m.halves[1 - h]);
    alone += total(m.halves[1 - h][m.best]);
  }
  return alone > 0 ? mixed / alone : 1;
}

/// The best entrant by itself, `n` iterations an estimate.
Plan alone(const Race& race, int n) {
  const std::size_t best = race.best();
  const std::size_t blocks = race.entrants()[best].trial.grid().blocks();
  Plan plan;
  plan.iterations.assign(race.entrants().size(), 0);
  plan.counts.resize(race.entrants().size());
  plan.weights.resize(race.entrants().size());
  plan.iterations[best] = n;
  plan.counts[best].assign(blocks, n);
  plan.weights[best].assign(blocks, 1.0F);
  plan.error = race.entrants()[best].standing.error;
  return plan;
}

/// Whether an estimate of this length leaves room for many.
bool fits(const Race& race, double length) {
  return race.limits().budget == 0 || length <= race.limits().budget * longest_estimate;
}

/// Numbers and weights of the entrants' shares in an estimate of cost `length`.
void share_out(const Race& race, const Mixable& m, const Shares& shares, double length,
               Plan& plan) {
  const std::size_t blocks = m.errors[0].size();
  std::vector<double> sums(blocks, 0.0);
  std::vector<std::vector<double>> precisions(m.who.size(), sums);
  for (std::size_t i = 0; i < m.who.size(); ++i) {
    const std::size_t k = m.who[i];
    const double one = race.entrants()[k].trial.iteration_cost();
    std::vector<int>& counts = plan.counts[k];
    counts.resize(blocks);
    for (std::size_t b = 0; b < blocks; ++b) {
      counts[b] = std::max(1, int(std::lround(shares[i][b] * length / one)));
      sums[b] += precisions[i][b] = counts[b] * one / m.errors[i][b];
    }
    plan.iterations[k] = *std::max_element(counts.begin(), counts.end());
  }
  for (std::size_t i = 0; i < m.who.size(); ++i) {
    std::vector<float>& weights = plan.weights[m.who[i]];
    weights.resize(blocks);
    for (std::size_t b = 0; b < blocks; ++b) weights[b] = float(precisions[i][b] / sums[b]);
  }
}

}  // namespace

int Plan::methods() const {
  return int(std::count_if(iterations.begin(), iterations.end(), [](int n) { return n > 0; }));
}

bool Plan::is_adaptive() const {
  for (std::size_t k = 0; k < iterations.size(); ++k) {
    const auto fewer = [&](int n) { return n < iterations[k]; };
    if (std::any_of(counts[k].begin(), counts[k].end(), fewer)) return true;
  }
  return false;
}

bool PlanFreedom::adapts() const {
  return std::any_of(by_block.begin(), by_block.end(), [](std::uint8_t b) { return b != 0; });
}

Plan make_plan(const Race& race, const PlanFreedom& freedom) {
  const std::vector<Entrant>& entrants = race.entrants();
  const std::size_t best = race.best();
  const double each = entrants[best].trial.iteration_cost();
  const bool adapts = freedom.adapts() && fits(race, least_to_adapt * each);
  const double cost = std::max(freedom.cost, adapts ? least_to_adapt * each : 0);
  int n = each > 0 ? std::max(1, int(cost / each)) : 1;
  if (adapts) n = std::max(n, least_to_adapt);
  const Plan plan = alone(race, n);
  if (!freedom.regions && !adapts) return plan;
  Mixable m = mixable(race, freedom, adapts);
  if (m.who.empty() || m.who[m.best] != best || (m.who.size() < 2 && !adapts)) return plan;
  Shares shares = best_shares(m.errors, m.by_block);
  // The rarest leave one by one: an estimate must hold one iteration of each.
  while (m.who.size() > 1) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < shares.size(); ++i) {
      if (share_of(shares[i]) < share_of(shares[least])) least = i;
    }
    if (share_of(shares[least]) >= least_share || least == m.best) break;
    m.erase(least);
    shares = best_shares(m.errors, m.by_block);
  }
  if (m.who.size() < 2 && m.by_block[0] == 0) return plan;
  const double gain = gain_between_halves(m);
  double length = cost;
  for (std::size_t i = 0; i < m.who.size(); ++i) {
    length = std::max(length, entrants[m.who[i]].trial.iteration_cost() / share_of(shares[i]));
  }
  if (gain > worthwhile_gain || !fits(race, length)) return plan;
  Plan shared = alone(race, 0);
  shared.counts[best].clear();
  shared.weights[best].clear();
  shared.gain = gain;
  shared.error =
      mixed_error(shares, m.errors, m.errors) / double(entrants[best].trial.grid().pixels());
  share_out(race, m, shares, length, shared);
  return shared;
}

std::vector<Tile> parts_of(const Plan& plan, const BlockGrid& grid, std::size_t entrant, int i,
                           std::span<const std::uint64_t> drawn, std::size_t& pixels) {
  constexpr int widest = 64;  // pixels: neighbours' rays are coherent
  const std::vector<int>& counts = plan.counts[entrant];
  std::vector<Tile> parts;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    if (counts[b] <= i) continue;
    const std::uint64_t before = drawn[b] + std::uint64_t(i);
    const V2i first = V2i(int(b) % grid.across, int(b) / grid.across) * grid.size;
    const V2i size(std::min(grid.size, grid.width - first.x),
                   std::min(grid.size, grid.height - first.y));
    pixels += std::size_t(size.x) * std::size_t(size.y);
    const bool joins = !parts.empty() && parts.back().first.y == first.y &&
                       parts.back().first.x + parts.back().size.x == first.x &&
                       parts.back().size.x + size.x <= widest &&
                       parts.back().samples_before == before;
    if (joins) {
      parts.back().size.x += size.x;
    } else {
      parts.push_back({first, size, before});
    }
  }
  return parts;
}

void combine(const Plan& plan, const BlockGrid& grid, const std::vector<Image>& sums, Image& out) {
  const bool alone = plan.methods() == 1;
  for (std::size_t k = 0; k < plan.iterations.size(); ++k) {
    if (plan.iterations[k] == 0) continue;
    std::size_t i = 0;
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x, ++i) {
        const std::size_t block = grid.block_of(x, y);
        const float weight = alone ? 1.0F : plan.weights[k][block];
        out.pixels[i] += sums[k].pixels[i] / float(plan.counts[k][block]) * weight;
      }
    }
  }
}

}  // namespace lacuna
