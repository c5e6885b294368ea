#pragma once

namespace lacuna {

/// Probability that Student's t with `df` >= 1 degrees of freedom lies in [-t, t], t >= 0; right to
/// 1e-5, up to t = 5 to 1e-9.
double student_within(double t, double df);

/// The t for which student_within(t, df) is `probability`, in (0, 1); df >= 1, also fractional
/// (Welch). Throws std::domain_error outside these ranges.
double student_bound(double probability, double df);

}  // namespace lacuna
