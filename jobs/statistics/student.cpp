#include "jobs/statistics/student.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lacuna {
namespace {

/// Integral of cos^(df - 1) from 0 to `angle`, by Simpson's rule. Beyond a few of its widths, 1 /
/// sqrt(df), the integrand adds nothing; the steps lie within them.
double cosine_power(double angle, double df) {
  constexpr int steps = 128;
  const double end = std::fmin(angle, 12 / std::sqrt(df));
  const double h = end / steps;
  const auto f = [&](int i) { return std::pow(std::fmax(std::cos(h * i), 0.0), df - 1); };
  double sum = f(0) + f(steps);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4 : 2) * f(i);
  return sum * h / 3;
}

/// The same from 0 to pi / 2, in closed form: sqrt(pi) / 2 * Gamma(df / 2) / Gamma((df + 1) / 2).
double whole(double df) {
  return 0.5 * std::sqrt(std::numbers::pi) *
         std::exp(std::lgamma(df / 2) - std::lgamma((df + 1) / 2));
}

}  // namespace

double student_within(double t, double df) {
  if (!(t >= 0) || !(df >= 1)) throw std::domain_error("Student's t needs t >= 0 and df >= 1");
  // With t = sqrt(df) tan(angle) the density is proportional to cos^(df - 1).
  return std::fmin(cosine_power(std::atan(t / std::sqrt(df)), df) / whole(df), 1.0);
}

double student_bound(double probability, double df) {
  if (!(probability > 0 && probability < 1) || !(df >= 1)) {
    throw std::domain_error("Student's t needs a probability in (0, 1) and df >= 1");
  }
  // Many intervals in a row have the same number of replicates.
  struct Known {
    double probability = 0, df = 0, t = 0;
  };
  thread_local Known known;
  if (known.probability == probability && known.df == df) return known.t;
  // What lies within t is a concave function of t: Newton's steps from its left never overshoot.
  double t = 0;
  for (int i = 0; i < 200; ++i) {
    const double density =
        std::exp(-(df + 1) / 2 * std::log1p(t * t / df)) / (std::sqrt(df) * whole(df));
    const double step = (probability - student_within(t, df)) / density;
    t += step;
    if (!(step > 1e-12 * t)) break;
  }
  known = {probability, df, t};
  return t;
}

}  // namespace lacuna
