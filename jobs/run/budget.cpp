#include "jobs/run/budget.h"

#include <algorithm>

namespace lacuna {

bool out_of_time(const Budget& budget, const Spent& spent) {
  return (budget.seconds && spent.seconds >= *budget.seconds) ||
         (budget.cpu_seconds && spent.cpu_seconds >= *budget.cpu_seconds);
}

bool exhausted(const Budget& budget, const Spent& spent) {
  return out_of_time(budget, spent) ||
         (budget.iterations && spent.iterations >= static_cast<std::uint64_t>(*budget.iterations));
}

bool would_overrun(const Budget& budget, const Spent& spent) {
  if (spent.iterations == 0) return false;
  const double next =
      static_cast<double>(spent.iterations + 1) / static_cast<double>(spent.iterations);
  return (budget.seconds && spent.seconds * next > *budget.seconds) ||
         (budget.cpu_seconds && spent.cpu_seconds * next > *budget.cpu_seconds);
}

bool target_met(const Budget& budget, const Curve& curve) {
  if (!budget.error || curve.rows().empty()) return false;
  const auto value = curve.rows().back().value(budget.error->metric);
  return value && *value <= budget.error->target;
}

double share(const Budget& budget, const Spent& spent) {
  double s = 0;
  if (budget.seconds) s = std::max(s, spent.seconds / *budget.seconds);
  if (budget.cpu_seconds) s = std::max(s, spent.cpu_seconds / *budget.cpu_seconds);
  if (budget.iterations) {
    s = std::max(s,
                 static_cast<double>(spent.iterations) / static_cast<double>(*budget.iterations));
  }
  return std::min(s, 1.0);
}

}  // namespace lacuna
