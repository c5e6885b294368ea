#include "jobs/sweep/distributions.h"

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace lacuna {
namespace {

/// Double throughout: twelve digits suffice, and it compiles in two thirds of the time.
using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Student = boost::math::students_t_distribution<double, Policy>;

}  // namespace

double student_within(double t, double df) {
  if (!(t >= 0)) throw std::domain_error("Student's t needs t >= 0");
  return 1 - student_beyond(t, df);
}

double student_beyond(double t, double df) { return 2 * cdf(complement(Student(df), std::abs(t))); }

double student_bound(double probability, double df) {
  if (!(probability > 0 && probability < 1)) {
    throw std::domain_error("Student's t needs a probability in (0, 1)");
  }
  // Cached: many consecutive intervals have the same number of replicates.
  struct Known {
    double probability = 0, df = 0, t = 0;
  };
  thread_local Known known;
  if (known.probability != probability || known.df != df) {
    known = {probability, df, quantile(complement(Student(df), (1 - probability) / 2))};
  }
  return known.t;
}

double chi_square_beyond(double x, double df) {
  if (!(x >= 0)) throw std::domain_error("a chi-square variable is 0 or more");
  return boost::math::gamma_q(df / 2, x / 2, Policy());
}

}  // namespace lacuna
