#include "renderer/path/learned_probability.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/settings/guide_settings.h"

namespace lacuna {

namespace {

/// Of Adam, as published; the rate is that of Mueller 2019.
constexpr double rate = 0.01, decay_of_mean = 0.9, decay_of_square = 0.999, tiny = 1e-30;

/// The parameter's range. c >= most_guided / (1 + e^7) = 8e-4: the guide's density is recovered
/// from the mixture's, whose float is exact to some 1e-6, with an error of 1e-6 / c of the BSDF's.
/// Mueller bounds the parameter by a penalty, whose weight depends on the unit of light.
constexpr double bound = 7;

double sigmoid(double t) { return 1 / (1 + std::exp(-t)); }

/// The derivative of the divergence by the probability of the cell, which was `before` when the
/// sample was taken and is `now`; 0: the sample was not one of the mixture.
double slope(const TrainingSample& s, double before, double now) {
  const double sampled = double(s.cell.probability);  // times the share that the cell covers
  if (!(s.pdf > 0) || !(sampled > 0) || !(sampled < 1)) return 0;
  const double bsdf = double(s.bsdf_pdf);
  const double guide = std::max(0.0, (double(s.pdf) - (1 - sampled) * bsdf) / sampled);
  const double covered = sampled / before, c = covered * now;
  return -double(s.reflected) * covered * (guide - bsdf) / (c * guide + (1 - c) * bsdf);
}

}  // namespace

double LearnedProbability::first() { return most_guided * sigmoid(0); }

void LearnedProbability::Cell::step(double gradient) {
  mean += (1 - decay_of_mean) * (gradient - mean);
  square += (1 - decay_of_square) * (gradient * gradient - square);
  first_mean *= decay_of_mean;
  first_square *= decay_of_square;
  const double m = mean / (1 - first_mean), v = square / (1 - first_square);
  parameter = std::clamp(parameter - rate * m / (std::sqrt(v) + tiny), -bound, bound);
}

void LearnedProbability::learn(Cell& cell, std::span<const TrainingSample> samples) {
  for (const TrainingSample& s : samples) {
    const double share = sigmoid(cell.parameter);
    const double of_parameter = most_guided * share * (1 - share);
    const double gradient = slope(s, cell.probability, most_guided * share) * of_parameter;
    if (gradient != 0 && std::isfinite(gradient)) cell.step(gradient);
  }
  cell.probability = most_guided * sigmoid(cell.parameter);
}

void LearnedProbability::update(const TrainingSamples& samples, const ThreadPool& pool) {
  pool.for_each(static_cast<int>(cells_.size()), [&](int i) {
    const auto cell = static_cast<std::size_t>(i);
    learn(cells_[cell], samples.of(cell));
  });
}

void LearnedProbability::divide(std::span<const std::uint32_t> origins) {
  for (const std::uint32_t from : origins) cells_.push_back(Cell(cells_[from]));
}

double LearnedProbability::mean() const {
  double sum = 0, cells = 0;
  for (const Cell& c : cells_) {
    if (c.first_mean == 1) continue;  // without samples
    sum += c.probability;
    ++cells;
  }
  return cells > 0 ? sum / cells : first();
}

void LearnedProbability::load(ByteReader& in, std::size_t cells) {
  std::vector<Cell> saved = in.get_vector<Cell>();
  bool good = saved.size() == cells;
  for (const Cell& c : saved) {
    good = good && std::abs(c.parameter) <= bound && std::isfinite(c.mean) && c.square >= 0 &&
           c.first_mean <= 1 && c.first_square <= 1 && c.probability >= 0 &&
           c.probability <= most_guided;
  }
  if (!good) throw std::runtime_error("saved probabilities belong to another scene");
  cells_ = std::move(saved);
}

}  // namespace lacuna
