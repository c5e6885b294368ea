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

Spread Spread::of(double left, double count) {
  Spread s{.left = std::clamp(left, 1 / count, 1.0), .count = count};
  if (count > 1) s.later = -std::log(s.left) / std::log(count) / 2;
  return s;
}

void Spread::steepen(double before, double count_before, double now) {
  if (!(before > 0) || !(now > 0) || !(count > count_before)) return;
  const double slope = std::log(before / now) / std::log(count / count_before);
  later = (later + std::clamp(slope, 0.0, 1.0)) / 2;
}

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

std::optional<Spread> SpreadGauge::spread(double variance) const {
  if (count_ < fewest || !(variance > 0)) return std::nullopt;
  const double now = error() * double(count_);
  Spread s = Spread::of(now / variance, double(count_));
  const auto marks = std::bit_width(count_ / 4 / fewest);  // of at most a quarter of all
  if (marks > 0) {
    const double before = double(fewest << (marks - 1));
    s.steepen(errors_[std::size_t(marks) - 1] * before, before, now);
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
