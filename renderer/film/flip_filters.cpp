#include "renderer/film/flip_filters.h"

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

constexpr double pi = std::numbers::pi;

/// The term a sqrt(pi / b) exp(-pi^2 x^2 / b) of a contrast sensitivity, x in degrees (table 1).
struct SensitivityTerm {
  double a, b;
};
constexpr SensitivityTerm achromatic_term{1, 0.0047};
constexpr SensitivityTerm red_green_term{1, 0.0053};
constexpr SensitivityTerm blue_yellow_terms[] = {{34.1, 0.04}, {13.5, 0.025}};

/// All three filters reach three standard deviations of the widest term.
int sensitivity_radius() {
  const double deviation = std::sqrt(blue_yellow_terms[0].b / (2 * pi * pi));
  return static_cast<int>(std::ceil(3 * deviation * flip_pixels_per_degree));
}

/// The term along one axis, of sum 1, and its sum before that.
struct Normalized {
  FlipKernel kernel;
  double sum = 0;
};
Normalized normalized(const SensitivityTerm& term) {
  const auto value = [&](int i) {
    const double x = i / flip_pixels_per_degree;
    return std::exp(-pi * pi * x * x / term.b);
  };
  const int radius = sensitivity_radius();
  Normalized n;
  for (int i = -radius; i <= radius; ++i) n.sum += value(i);
  // Weights that a float cannot add to the sum take time only.
  constexpr double negligible = 1e-9;
  n.kernel.radius = radius;
  while (n.kernel.radius > 0 && value(n.kernel.radius) < negligible) --n.kernel.radius;
  for (int i = -n.kernel.radius; i <= n.kernel.radius; ++i) {
    n.kernel.weights.push_back(static_cast<float>(value(i) / n.sum));
  }
  return n;
}

void add_blue_yellow(FlipFilters& filters) {
  double shares[2], all = 0;
  for (int k = 0; k < 2; ++k) {
    const auto& term = blue_yellow_terms[k];
    Normalized n = normalized(term);
    shares[k] = term.a * std::sqrt(pi / term.b) * n.sum * n.sum;
    all += shares[k];
    filters.blue_yellow[k] = std::move(n.kernel);
  }
  for (int k = 0; k < 2; ++k) filters.blue_yellow_share[k] = static_cast<float>(shares[k] / all);
}

/// Scales the positive weights to the sum 1, the negative ones to -1.
FlipKernel balanced(int radius, const std::vector<double>& weights) {
  double positive = 0, negative = 0;
  for (const double w : weights) (w > 0 ? positive : negative) += std::abs(w);
  FlipKernel kernel{radius, {}};
  for (const double w : weights) {
    kernel.weights.push_back(static_cast<float>(w > 0 ? w / positive : w / negative));
  }
  return kernel;
}

void add_features(FlipFilters& filters) {
  constexpr double width = 0.082;  // degrees between an edge detector's peak and its trough
  const double sd = 0.5 * width * flip_pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sd));
  std::vector<double> edge, point, across;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    const double g = std::exp(-i * i / (2 * sd * sd));
    edge.push_back(-i * g);
    point.push_back((i * i / (sd * sd) - 1) * g);
    across.push_back(g);
    sum += g;
  }
  filters.edge = balanced(radius, edge);
  filters.point = balanced(radius, point);
  filters.across.radius = radius;
  for (const double g : across) filters.across.weights.push_back(static_cast<float>(g / sum));
}

}  // namespace

const FlipFilters& flip_filters() {
  static const FlipFilters filters = [] {
    FlipFilters f;
    f.achromatic = normalized(achromatic_term).kernel;
    f.red_green = normalized(red_green_term).kernel;
    add_blue_yellow(f);
    add_features(f);
    f.reach = std::max(sensitivity_radius(), f.edge.radius);
    return f;
  }();
  return filters;
}

}  // namespace lacuna
