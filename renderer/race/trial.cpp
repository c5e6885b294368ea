#include "renderer/race/trial.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/film/pareto_tail.h"
#include "renderer/film/saved_values.h"

namespace lacuna {

namespace {

std::optional<ParetoTail> tail_of(const SquaredErrors& errors) {
  return pareto_tail(errors.largest(), errors.count());
}

double total_of(const std::array<std::vector<double>, 2>& sums) {
  double total = 0;
  for (const auto& half : sums) {
    for (const double v : half) total += v;
  }
  return total;
}

}  // namespace

Trial::Trial(int width, int height, int reduction) : grid_(width, height) {
  grid_.reduction = reduction;
  mean_ = Image(grid_.trial_width(), grid_.trial_height());
  for (auto& s : sums_) s.assign(grid_.blocks(), 0.0);
}

void Trial::restart_whole() {
  const std::uint64_t iterations = charged_;
  const double cost = cost_;
  *this = Trial(grid_.width, grid_.height);
  charged_ = iterations;
  cost_ = cost_of_smaller_ = cost;
}

void Trial::charge(double cost, double share) {
  ++charged_;
  pictures_charged_ += share;
  cost_ += cost;
}

void Trial::add(const Image& estimate) {
  const auto before = double(estimates_++);
  const auto share = float(1 / (before + 1));
  if (before == 0) {
    mean_.pixels = estimate.pixels;
    return;
  }
  // A deviation from the mean of those before has 1 + 1/n times the variance.
  const double unbiased = before / (before + 1) / 3;
  std::vector<double>& sums = sums_[(estimates_ % 2 == 0) ? 0 : 1];
  SquaredErrors::Sums pictures{};
  std::size_t i = 0;
  const int width = grid_.trial_width(), height = grid_.trial_height();
  for (int y = 0; y < height; ++y) {
    double* row = &pictures[std::size_t(y % SquaredErrors::side) * SquaredErrors::side];
    for (int x = 0; x < width; ++x, ++i) {
      const Rgb d = estimate.pixels[i] - mean_.pixels[i];
      const double square = (double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z) * unbiased;
      mean_.pixels[i] += d * share;
      sums[grid_.block_of(x, y)] += square * grid_.weight(x, y);
      row[x % SquaredErrors::side] += square;
    }
  }
  pictures_.add(pictures, width, height);
}

std::vector<double> Trial::variances(int half) const {
  const std::uint64_t deviations = estimates_ > 0 ? estimates_ - 1 : 0;
  const std::uint64_t n = half == 0 ? (deviations + 1) / 2 : deviations / 2;
  std::vector<double> result = sums_[std::size_t(half)];
  for (double& v : result) v /= double(std::max<std::uint64_t>(1, n));
  return result;
}

std::vector<double> Trial::variances() const {
  const double n = std::max(1.0, double(estimates_) - 1);
  std::vector<double> result = sums_[0];
  for (std::size_t b = 0; b < result.size(); ++b) result[b] = (result[b] + sums_[1][b]) / n;
  return result;
}

double Trial::growth(double iterations) const {
  const auto tail = tail_of(pictures_);
  const double mean = total_of(sums_) / (double(estimates_) - 1) / double(grid_.pixels());
  if (!tail || !(mean > 0)) return 1;
  const auto now = double(pictures_.count());
  const double later = now * (1 + iterations / (double(estimates_) - 1));
  return 1 + std::max(0.0, tail->mean_above(later) - tail->mean_above(now)) / mean;
}

std::optional<bool> Trial::tail_is_known() const {
  const auto tail = tail_of(pictures_);
  return tail ? std::optional(tail->mean_is_known()) : std::nullopt;
}

void Trial::save(ByteWriter& out) const {
  out.put(grid_.reduction);
  out.put(estimates_);
  out.put(charged_);
  out.put(cost_);
  out.put(cost_of_smaller_);
  out.put(pictures_charged_);
  put_image(out, mean_);
  for (const auto& s : sums_) out.put(s);
  pictures_.save(out);
}

void Trial::load(ByteReader& in) {
  const auto reduction = in.get<int>();
  if (reduction < 1 || reduction > std::max(grid_.width, grid_.height)) {
    throw std::runtime_error("saved trial of a method has pictures of another size");
  }
  *this = Trial(grid_.width, grid_.height, reduction);
  estimates_ = in.get<std::uint64_t>();
  charged_ = in.get<std::uint64_t>();
  cost_ = in.get<double>();
  cost_of_smaller_ = in.get<double>();
  pictures_charged_ = in.get<double>();
  get_image(in, mean_, "trial of a method");
  const bool charged = pictures_charged_ >= 0 && pictures_charged_ <= double(charged_) * (1 + 1e-9);
  const bool cost = cost_of_smaller_ >= 0 && cost_ >= cost_of_smaller_ && std::isfinite(cost_);
  if (!cost || !charged || estimates_ > charged_) {
    throw std::runtime_error("saved trial of a method is not one");
  }
  for (auto& s : sums_) s = get_finite(in, grid_.blocks(), "variances of blocks");
  pictures_.load(in);
}

}  // namespace lacuna
