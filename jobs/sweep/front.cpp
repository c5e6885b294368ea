#include "jobs/sweep/front.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna {
namespace {

/// A contender with its mean curve, on the axis of total time.
class Entrant {
 public:
  explicit Entrant(const Contender& c)
      : contender_(c), mean_(curve_of(mean_curve(c.curves), c.curves)) {}

  bool empty() const { return mean_.empty(); }
  double begin() const { return mean_.begin() + contender_.preparation; }
  double end() const { return mean_.end() + contender_.preparation; }

  /// The render time at which its picture at a total time was finished.
  double own_time(double total) const {
    // Adding and subtracting may round below the first instant.
    return std::clamp(total - contender_.preparation, mean_.begin(), mean_.end());
  }
  std::optional<CurvePoint> at(double total) const {
    if (empty() || total < begin()) return {};
    return mean_.at(own_time(total));
  }
  std::vector<double> errors_at(double total) const {
    std::vector<double> errors;
    for (const ErrorCurve& curve : contender_.curves) {
      if (const auto p = curve.at(own_time(total))) errors.push_back(p->error);
    }
    return errors;
  }

 private:
  Contender contender_;
  ErrorCurve mean_;
};

/// Whether the difference of the two is not significant.
bool not_told_apart(const Entrant& a, const Entrant& b, double total) {
  const auto ea = a.errors_at(total), eb = b.errors_at(total);
  if (ea.empty() || eb.empty()) return false;
  return may_be_equal(ea, eb);
}

FrontPart part_at(const std::vector<Entrant>& entrants, double total) {
  FrontPart part{total, total, entrants.size(), {}, std::numeric_limits<double>::infinity(), false};
  for (std::size_t i = 0; i < entrants.size(); ++i) {
    const auto p = entrants[i].at(total);
    if (p && p->error < part.error) {
      part.best = i;
      part.error = p->error;
      part.at_floor = p->at_floor;
    }
  }
  for (std::size_t i = 0; i < entrants.size(); ++i) {
    if (i == part.best || !entrants[i].at(total)) continue;
    if (not_told_apart(entrants[i], entrants[part.best], total)) part.tied.push_back(i);
  }
  return part;
}

void join(FrontPart& last, const FrontPart& next) {
  last.to = next.to;
  last.error = next.error;
  last.at_floor |= next.at_floor;
  std::vector<std::size_t> all;
  std::set_union(last.tied.begin(), last.tied.end(), next.tied.begin(), next.tied.end(),
                 std::back_inserter(all));
  last.tied = std::move(all);
}

/// The instants of all curves, including their begins, where the front may jump.
std::vector<double> instants_of(const std::vector<Entrant>& entrants) {
  std::vector<double> begins;
  double last = 0;
  for (const Entrant& e : entrants) {
    if (e.empty()) continue;
    begins.push_back(e.begin());
    last = std::max(last, e.end());
  }
  if (begins.empty()) return {};
  std::vector<double> instants =
      instants_between(*std::min_element(begins.begin(), begins.end()), last);
  instants.insert(instants.end(), begins.begin(), begins.end());
  std::sort(instants.begin(), instants.end());
  instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
  return instants;
}

}  // namespace

std::vector<FrontPart> pareto_front(std::span<const Contender> contenders) {
  const std::vector<Entrant> entrants(contenders.begin(), contenders.end());
  std::vector<FrontPart> front;
  for (const double total : instants_of(entrants)) {
    const FrontPart part = part_at(entrants, total);
    if (part.best == entrants.size()) continue;
    if (!front.empty() && front.back().best == part.best) {
      join(front.back(), part);
    } else {
      if (!front.empty()) front.back().to = total;
      front.push_back(part);
    }
  }
  return front;
}

std::optional<BreakEven> break_even(const Contender& cell, const Contender& baseline) {
  const Entrant c(cell), b(baseline);
  if (c.empty() || b.empty()) return {};
  // Before the cell's first picture the baseline's is better.
  const double first = std::max(c.begin(), b.begin()), last = std::min(c.end(), b.end());
  if (first > last) return {};
  const auto lead = [&](double t) { return std::log(b.at(t)->error / c.at(t)->error); };
  std::optional<BreakEven> answer = BreakEven{first, c.begin() <= b.begin()};
  double before = first;
  for (const double t : instants_between(first, last)) {
    if (lead(t) < 0) {
      answer.reset();
    } else if (!answer) {
      const double d0 = lead(before), d1 = lead(t);
      answer = BreakEven{before * std::pow(t / before, d0 / (d0 - d1)), false};
    }
    before = t;
  }
  return answer;
}

}  // namespace lacuna
