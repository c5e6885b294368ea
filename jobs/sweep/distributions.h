#pragma once

namespace lacuna {

// Tails of distributions, to twelve digits. Each throws std::domain_error outside its range.

/// Probability that Student's t with `df` > 0 degrees of freedom, also fractional (Welch), lies in
/// [-t, t].
double student_within(double t, double df);
/// Probability that it lies further from 0 than `t`.
double student_beyond(double t, double df);
/// The t for which student_within(t, df) is `probability`, in (0, 1).
double student_bound(double probability, double df);

/// Probability that a chi-square variable with `df` > 0 degrees of freedom exceeds `x` >= 0.
double chi_square_beyond(double x, double df);

}  // namespace lacuna
