#include "renderer/race/spread_gauge.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/film/film.h"
#include "renderer/film/saved_values.h"

namespace lacuna {

namespace {

constexpr std::uint64_t fewest = 8;  // estimates that tell anything

}  // namespace

double Spread::left_of(double n) const {
  if (!(count > 1) || !(n > 1)) return 1;
  if (n < count) return std::pow(left, std::log(n) / std::log(count));
  return left * std::pow(n / count, -later);
}

void SpreadGauge::add(const Image& estimate) {
  Image& sum = sums_[count_++ % 2];
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += estimate.pixels[i];
  if (count_ >= fewest && std::has_single_bit(count_)) errors_.push_back(error());
}

double SpreadGauge::error() const {
  const auto odd = double(count_ / 2), even = double(count_) - odd;
  double apart = 0;
  for (std::size_t i = 0; i < sums_[0].pixels.size(); ++i) {
    const Rgb d = sums_[0].pixels[i] / float(even) - sums_[1].pixels[i] / float(odd);
    apart += (double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z) / 3;
  }
  return apart * scale_from_halves(even, odd);
}

/// A straight line in logarithms from one estimate on falls too fast later, and the slope at the
/// end is noisy: the mean of half of the one and of the other is within 1.5 of the error after 64
/// times as many estimates, for path tracing on cornell-box, area, atrium, door and the
/// bidirectional method on cornell and atrium.
std::optional<Spread> SpreadGauge::spread(double variance) const {
  if (count_ < fewest || !(variance > 0)) return std::nullopt;
  const auto n = double(count_);
  const double now = error() * n;
  Spread s{.left = std::clamp(now / variance, 1 / n, 1.0), .count = n};
  s.later = -std::log(s.left) / std::log(n) / 2;
  const auto fourth = std::bit_width(count_ / 4 / fewest);  // marks of at most n / 4
  if (fourth > 0 && now > 0) {
    const auto m = double(fewest << (fourth - 1));
    const double before = errors_[std::size_t(fourth) - 1] * m;
    const double slope = before > 0 ? std::log(before / now) / std::log(n / m) : 0;
    s.later = (s.later + std::clamp(slope, 0.0, 1.0)) / 2;
  }
  return s;
}

void SpreadGauge::save(ByteWriter& out) const {
  out.put(count_);
  out.put(errors_);
  for (const Image& sum : sums_) put_image(out, sum);
}

void SpreadGauge::load(ByteReader& in) {
  count_ = in.get<std::uint64_t>();
  const auto marks = std::size_t(std::bit_width(count_ / fewest));
  errors_ = get_finite(in, marks, "errors of spread samples");
  for (Image& sum : sums_) get_image(in, sum, "sum of spread samples");
}

}  // namespace lacuna
