#include "renderer/visibility/probabilistic_visibility.h"

#include <set>

namespace lacuna {

/// The guesses of the points that are gathered together, and the results of their tests.
struct ProbabilisticVisibility::Tile {
  std::vector<std::unique_ptr<GuessSource::Tile>> sources;
  VisibilityEstimate of_source;
  GuessAnswers answers;
  std::vector<std::uint32_t> cells;              // of the points, each once
  std::size_t row = 0;                           // tallies of each of `cells`
  std::vector<GuessReliability::Tally> tallies;  // of each cell of a point, cell of lights and code
  std::array<Tested, Lanes::size> tested;        // of the block of the last decision
  GuessReliability* reliability = nullptr;       // null: nothing is learned
  std::size_t light_cells = 0;

  Tile() = default;
  Tile(const Tile&) = delete;
  Tile& operator=(const Tile&) = delete;
  ~Tile() {
    if (reliability == nullptr) return;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      reliability->add(cells[i] * light_cells, std::span(tallies).subspan(i * row, row));
    }
  }

  /// The mean guess of the sources that know something of a light.
  void guess(std::size_t point, std::size_t block, const Terms& terms, VisibilityEstimate& d) {
    answers.clear();
    sources[0]->guess(point, block, terms, d);
    if (reliability != nullptr) answers.append(d);
    if (sources.size() == 1) return;
    Lanes known;
    const auto add = [&](const VisibilityEstimate& e, bool first) {
      for (int k = 0; k < Lanes::groups; ++k) {
        const Mask8 unknown = mask_from_bits(static_cast<unsigned>(e.tests >> (8 * k) & 0xff));
        known.set(k, known.eight(k) + select(unknown, 0, 1));
        if (!first) d.untested.set(k, d.untested.eight(k) + e.untested.eight(k));
      }
    };
    add(d, true);
    for (std::size_t s = 1; s < sources.size(); ++s) {
      sources[s]->guess(point, block, terms, of_source);
      answers.append(of_source);
      add(of_source, false);
    }
    d.tests = VplContributions::all_lights & ~positive(known);
    for (int k = 0; k < Lanes::groups; ++k) {
      d.untested.set(k, d.untested.eight(k) / max(1, known.eight(k)));
    }
  }
};

ProbabilisticVisibility::ProbabilisticVisibility(const ProbabilisticVisibilitySettings& settings,
                                                 std::vector<std::unique_ptr<GuessSource>> sources)
    : settings_(settings),
      sources_(std::move(sources)),
      own_points_(settings.variance_points, settings.neighbours, CachePoints::Keep::variances) {
  for (const auto& s : sources_) {
    if (const auto* cached = dynamic_cast<const GuessOf<CachePointsGuess>*>(s.get())) {
      points_ = &cached->visibility().points();
    }
  }
  if (learns()) reliability_.resize(1, GuessAnswers::codes(sources_.size()));
}

bool ProbabilisticVisibility::needs_space() const {
  return settings_.reliability_cells() ||
         std::any_of(sources_.begin(), sources_.end(),
                     [](const auto& s) { return s->needs_space(); });
}

void ProbabilisticVisibility::prepare(const PrepareContext& context) {
  for (const auto& s : sources_) s->prepare(context);
  if (!settings_.reliability_cells()) return;
  clusters_.emplace(context.space);
  cells_ = clusters_->count() + 1;  // the last: of what belongs to no cluster
  reliability_.resize(cells_ * cells_, GuessAnswers::codes(sources_.size()));
}

std::uint64_t ProbabilisticVisibility::groups() const {
  std::uint64_t product = 1;
  for (const auto& s : sources_) product *= s->groups() + 1;
  return product;
}

LightGroup ProbabilisticVisibility::group(const VplGeometry& light) const {
  LightGroup all = 0;
  for (const auto& s : sources_) {
    all = all * (s->groups() + 1) + std::min(s->group(light), s->groups());
  }
  return all;
}

std::vector<BlockRange> ProbabilisticVisibility::passes(const VplSet& lights) const {
  std::set<std::size_t> starts;
  for (const auto& s : sources_) {
    for (const BlockRange& range : s->passes(lights)) starts.insert(range.first);
  }
  std::vector<BlockRange> ranges;
  for (const std::size_t first : starts) {
    if (!ranges.empty()) ranges.back().end = first;
    ranges.push_back({first});
  }
  return ranges;
}

Counters ProbabilisticVisibility::begin(const LightPass& pass) {
  Counters counters;
  other_rays_ = eye_rays_per_light(pass);
  for (const auto& s : sources_) counters += s->begin(pass);
  if (!pass.lights.is_first()) return counters;
  if (points_ == nullptr) counters += own_points_.build(pass);
  reliability_.discard();
  const VplSet& lights = pass.terms.lights();
  block_cells_.assign(lights.blocks(), 0);
  for (std::size_t b = 0; clusters_ && b < lights.blocks(); ++b) {
    // Lights of a block are near each other: the first stands for all.
    block_cells_[b] = cell(lights.geometry(b, 0));
  }
  return counters;
}

ProbabilisticVisibility::At ProbabilisticVisibility::at(const ShadingPoint& point,
                                                        const IterationContext& context) const {
  const CachePoints& points = points_ != nullptr ? *points_ : own_points_;
  const auto neighbours =
      settings_.variance == VarianceOf::picture ? CachePoints::Neighbours{} : points.nearest(point);
  float guesses = 0;
  for (const auto& s : sources_) guesses += s->cost();
  return {{.k = other_rays_ + static_cast<float>(settings_.term_cost) + guesses,
           .c = 1,
           .least = static_cast<float>(settings_.epsilon_probability),
           .over_sigma = 1 / points.deviation(settings_.variance, point, neighbours)},
          {context.seed, context.iteration, point.pixel, Rng::Purpose::visibility},
          clusters_ ? std::min(clusters_->of(point), clusters_->count()) : 0};
}

void ProbabilisticVisibility::share(std::span<const ShadingPoint> points, std::span<At> states,
                                    const IterationContext& context) const {
  const auto tile = std::make_shared<Tile>();
  for (const auto& s : sources_) tile->sources.push_back(s->tile(points, context));
  for (std::size_t i = 0; i < states.size(); ++i) {
    At& at = states[i];
    at.tile = tile;
    at.point = static_cast<std::uint32_t>(i);
    const auto found = std::find(tile->cells.begin(), tile->cells.end(), at.cell);
    at.place = static_cast<std::uint32_t>(found - tile->cells.begin());
    if (found == tile->cells.end()) tile->cells.push_back(at.cell);
  }
  if (!learns()) return;
  tile->reliability = &reliability_;
  tile->light_cells = cells_;
  tile->row = cells_ * reliability_.codes();
  tile->tallies.resize(tile->cells.size() * tile->row);
}

void ProbabilisticVisibility::decide(At& at, std::size_t block, const Terms& terms,
                                     VisibilityEstimate& d) const {
  Tile& tile = *at.tile;
  tile.guess(at.point, block, terms, d);
  const float* const rates = learns() ? reliability_.rates(pair(at.cell, block)) : nullptr;
  const auto least = static_cast<float>(settings_.epsilon_variance);
  constexpr float unknown =
      std::numeric_limits<float>::infinity();  // lights of unknown visibility are tested
  const TestProbability chance = at.chance;
  TestSampler sampler;
  for (int k = 0; k < Lanes::groups; ++k) {
    if (rates != nullptr) d.untested.set(k, gather(rates, tile.answers.eight(k)));
    const Float8 q = d.untested.eight(k);
    const Float8 t = terms.luminance.eight(k);
    const Mask8 is_unknown = mask_from_bits(static_cast<unsigned>(d.tests >> (8 * k) & 0xff));
    const Float8 var =
        rates != nullptr ? q * (1 - q) : select(is_unknown, unknown, max(least, q * (1 - q)));
    sampler.set(k, chance.of(t, var, terms.weight), t);
  }
  d.tests = sampler.sample(settings_.draws, at.rng);
  for_each_bit(d.tests, [&](int i) {
    const float x = sampler.probability(i);
    d.untested[i] *= (x - 1) / x;
    d.gain[i] = 1 / x;
  });
  if (!learns()) return;
  const std::size_t first = at.place * tile.row + block_cells_[block] * reliability_.codes();
  for_each_bit(d.tests, [&](int i) {
    Tested& test = tile.tested[static_cast<std::size_t>(i)];
    test.tally = static_cast<std::uint32_t>(first + tile.answers[i]);
    test.weight = sampler.inverse(i, GuessReliability::one);
    GuessReliability::Tally& tally = tile.tallies[test.tally];
    ++tally.tests;
    tally.weights += test.weight;
  });
}

ProbabilisticVisibility::Tested ProbabilisticVisibility::tested(const At& at, int light) {
  return at.tile->tested[static_cast<std::size_t>(light)];
}

void ProbabilisticVisibility::seen(At& at, Tested test) {
  if (at.tile->reliability != nullptr) at.tile->tallies[test.tally].visible += test.weight;
}

std::vector<std::pair<std::string, double>> ProbabilisticVisibility::statistics() const {
  std::vector<std::pair<std::string, double>> stats{
      {"cache_points", static_cast<double>((points_ ? points_ : &own_points_)->size())}};
  const std::vector<GuessReliability::Tally> totals = reliability_.totals();
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    for (auto& [name, value] : sources_[s]->statistics()) {
      if (name != "cache_points") stats.emplace_back(name, value);
    }
    std::array<GuessReliability::Tally, GuessAnswers::answers> by_answer{};
    for (std::size_t code = 0; code < totals.size(); ++code) {
      by_answer[GuessAnswers::answer(code, s, sources_.size())] += totals[code];
    }
    if (!learns()) continue;
    const auto rate = [&](GuessAnswers::Answer a) {
      return by_answer[a].tests > 0 ? by_answer[a].rate() : 0.0;
    };
    const std::string name(sources_[s]->name());
    stats.emplace_back(name + "_wrong_if_occluded", rate(GuessAnswers::occluded));
    stats.emplace_back(name + "_wrong_if_visible", by_answer[GuessAnswers::visible].tests > 0
                                                       ? 1 - rate(GuessAnswers::visible)
                                                       : 0.0);
  }
  return stats;
}

}  // namespace lacuna
