#include "tests/extremes/check.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/space/memory_limit.h"
#include "analysis/space/voxelize.h"
#include "jobs/spec/problems.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna::extremes {
namespace {

using statistics::Moments;

/// What rounding in float makes of a mean, at most, where all else is equal.
constexpr double float_rounding = 2e-5;
/// Largest standard error of a mean that still is a test of it.
constexpr double useful_error = 0.03;

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double mean_size(const Picture& a) {
  double sum = 0;
  const std::vector<double> values = a.film.mean();
  for (const double v : values) sum += std::abs(v);
  return sum / static_cast<double>(values.size());
}

/// p-value of "the mean is within `slack` of `expected`".
double near_p(const Moments& m, double expected, double slack) {
  const double off = m.mean() - expected;
  if (std::abs(off) <= slack) return 1;
  return statistics::t_test(m, expected + std::copysign(slack, off));
}

std::size_t different(const Picture& a, const Picture& b, double factor) {
  const std::vector<double> x = a.film.mean(), y = b.film.mean();
  if (x.size() != y.size()) return std::max(x.size(), y.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < x.size(); ++i) count += x[i] != factor * y[i] ? 1 : 0;
  return count;
}

}  // namespace

Moments mean_of(const Picture& a) {
  Moments m;
  for (const auto& blocks : a.blocks) m.add(mean(blocks));
  return m;
}

int degree(const Picture& twice, const Picture& once) {
  for (const int k : {0, 1, 2, -1, -2}) {
    if (different(twice, once, std::ldexp(1.0, k)) == 0) return k;
  }
  throw std::runtime_error("twice as much changes the picture by no power of two");
}

void Check::require(bool holds, const std::string& otherwise) {
  if (holds || verdict_.kind == Verdict::Kind::red) return;
  verdict_.kind = Verdict::Kind::red;
  verdict_.why = otherwise;
}

void Check::refused(const std::function<void()>& action, const std::string& word) {
  try {
    action();
  } catch (const std::exception& e) {
    const std::string said = e.what();
    require(said.find(word) != std::string::npos,
            fmt::format("refused, but \"{}\" does not say \"{}\"", said, word));
    return note_refusal(said);
  }
  require(false, fmt::format("was not refused; expected a word of \"{}\"", word));
}

void Check::or_refused(const std::function<void()>& action) {
  try {
    action();
  } catch (const BadJob& e) {
    note_refusal(e.what());
  } catch (const SceneError& e) {
    note_refusal(e.what());
  } catch (const GeometryError& e) {
    note_refusal(e.what());
  } catch (const MemoryLimitError& e) {
    note_refusal(e.what());
  }
}

void Check::note_refusal(const std::string& why) {
  require(!why.empty(), "was refused without a reason");
  if (verdict_.kind != Verdict::Kind::ok) return;
  verdict_.kind = Verdict::Kind::refused;
  verdict_.why = why;
}

void Check::sound(const Picture& a) {
  std::size_t bad = 0;
  for (const auto& values : {a.film.mean(), a.film.variance_of_mean()}) {
    for (const double v : values) bad += std::isfinite(v) ? 0 : 1;
  }
  require(bad == 0, fmt::format("{} values are not finite", bad));
  require(a.counters.rejected == 0, fmt::format("{} samples were rejected", a.counters.rejected));
}

void Check::same_bits(const Picture& a, const Picture& b, double factor) {
  sound(a);
  const std::size_t count = different(a, b, factor);
  require(count == 0, fmt::format("{} of {} values differ", count, a.film.mean().size()));
}

void Check::same_picture(const Picture& a, const Picture& b, double factor, double rounding) {
  sound(a);
  const double size = factor * mean_size(b);
  require(size > 0, "the picture is black: the test has no power");
  const std::size_t n = std::min(a.blocks.size(), b.blocks.size());
  Moments whole;
  for (std::size_t i = 0; i < n; ++i) whole.add(mean(a.blocks[i]) - factor * mean(b.blocks[i]));
  has_power(whole.standard_error(), size);
  for (std::size_t block = 0; block < a.blocks[0].size(); ++block) {
    Moments m, there;
    for (std::size_t i = 0; i < n; ++i) {
      m.add(a.blocks[i][block] - factor * b.blocks[i][block]);
      there.add(factor * b.blocks[i][block]);
    }
    const double slack = rounding * std::max(size, std::abs(there.mean()));
    test(near_p(m, 0, slack),
         fmt::format("block {} differs by {:.3g} of {:.3g}", block, m.mean(), there.mean()));
  }
}

void Check::agree(const Picture& a, const Picture& b) {
  sound(a);
  const Moments x = mean_of(a), y = mean_of(b);
  has_power(std::hypot(x.standard_error(), y.standard_error()), mean_size(b));
  for (std::size_t block = 0; block < a.blocks[0].size(); ++block) {
    Moments m, n;
    for (const auto& blocks : a.blocks) m.add(blocks[block]);
    for (const auto& blocks : b.blocks) n.add(blocks[block]);
    const double off = m.mean() - n.mean(), slack = float_rounding * std::abs(n.mean());
    test(std::abs(off) <= slack ? 1 : statistics::t_test(m, n),
         fmt::format("block {} is {:.4g}, and {:.4g} by the first method", block, m.mean(),
                     n.mean()));
  }
}

void Check::mean_is(const Picture& a, double expected) {
  sound(a);
  const Moments m = mean_of(a);
  has_power(m.standard_error(), expected);
  test(near_p(m, expected, float_rounding * expected),
       fmt::format("the mean is {:.6g}, expected {:.6g}", m.mean(), expected));
}

void Check::at_most(const Picture& a, double bound) {
  sound(a);
  for (std::size_t block = 0; block < a.blocks[0].size(); ++block) {
    Moments m;
    for (const auto& blocks : a.blocks) m.add(blocks[block]);
    const double limit = bound * (1 + float_rounding);
    test(m.mean() <= limit ? 1 : statistics::t_test(m, limit) / 2,
         fmt::format("block {} is {:.6g}, at most {:.6g} is possible", block, m.mean(), bound));
  }
}

void Check::test(double p, const std::string& what) {
  ++verdict_.tests;
  require(!std::isnan(p), what + ": no p-value");
  if (p >= verdict_.p) return;
  verdict_.p = p;
  verdict_.doubtful = what;
}

void Check::has_power(double standard_error, double mean) {
  require(standard_error <= useful_error * std::abs(mean),
          fmt::format("the test has no power: {:.3g} of noise on {:.3g}", standard_error, mean));
}

}  // namespace lacuna::extremes
