#include "renderer/film/film.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/film/saved_values.h"

namespace lacuna {

namespace {

/// The channels of the pixels in one period of SquaredErrors, so that the compiler vectorises loops
/// over them.
constexpr std::size_t lanes = 3 * SquaredErrors::side;
using Lanes = std::array<double, lanes>;

/// Addresses of the sums of one channel of a pixel.
struct SumPointers {
  double *sum, *sum_low, *squares, *squares_low;

  SumPointers operator+(std::size_t i) const {
    return {sum + i, sum_low + i, squares + i, squares_low + i};
  }
};

/// 1 over the number of iterations of the half, without and with the added one.
struct Shares {
  double before, with;
};

/// Adds up to `lanes` neighbouring values. `deviations` receives the products of Welford (1962),
/// whose sum over iterations is that of the squared deviations.
inline void add_values(const float* values, std::size_t count, const SumPointers& at,
                       const Shares& shares, Lanes& deviations, Lanes& lost) {
  for (std::size_t k = 0; k < count; ++k) {
    const double v = double(values[k]);
    PairSum sum{at.sum[k], at.sum_low[k]}, squares{at.squares[k], at.squares_low[k]};
    const double deviation = v - sum.high * shares.before;
    lost[k] += std::abs(add_to(sum, v));
    deviations[k] += deviation * (v - sum.high * shares.with);
    add_to(squares, v * v);
    at.sum[k] = sum.high;
    at.sum_low[k] = sum.low;
    at.squares[k] = squares.high;
    at.squares_low[k] = squares.low;
  }
}

/// Rows that are added together, by one thread: their sums are added in the order of the bands, so
/// that they have the same bits for any number of threads.
constexpr int rows_of_band = 32;
static_assert(rows_of_band % SquaredErrors::side == 0);

/// The sums of a band.
struct BandSums {
  SquaredErrors::Sums sums{};
  Lanes lost{};

  void add_row(const float* values, std::size_t row, int y, const SumPointers& at,
               const Shares& shares) {
    Lanes deviations{};
    std::size_t i = 0;
    for (; i + lanes <= row; i += lanes) {
      add_values(values + i, lanes, at + i, shares, deviations, lost);
    }
    add_values(values + i, row - i, at + i, shares, deviations, lost);
    double* of_row = &sums[std::size_t(y % SquaredErrors::side) * SquaredErrors::side];
    for (std::size_t k = 0; k < lanes; ++k) of_row[k / 3] += deviations[k];
  }
};

/// n times the sum of squares minus the square of the sum, at least 0. If all values are equal,
/// both products are exact and the difference is 0.
double scaled_deviations(double n, const PairSum& squares, const PairSum& sum) {
  PairSum d{n * squares.high, std::fma(n, squares.high, -(n * squares.high))};
  const double square = sum.high * sum.high;
  add_to(d, -square);
  add_to(d, -std::fma(sum.high, sum.high, -square));
  add_to(d, n * squares.low);
  const double mixed = 2 * sum.high * sum.low;
  add_to(d, -mixed);
  add_to(d, -std::fma(2 * sum.high, sum.low, -mixed));
  add_to(d, -sum.low * sum.low);
  return std::max(0.0, d.high);
}

}  // namespace

Film::Film(int width, int height)
    : width_(width), height_(height), squares_(3 * std::size_t(width) * std::size_t(height)) {
  for (Half& h : halves_) h.sums = ExactSums(squares_.size());
}

void Film::add(std::uint64_t iteration, const Image& estimate, const ThreadPool* pool) {
  Half& h = halves_[iteration % 2];
  const double before = h.n > 0 ? 1.0 / static_cast<double>(h.n) : 0;
  ++h.n;
  const Shares shares{before, 1.0 / static_cast<double>(h.n)};
  const std::size_t row = 3 * std::size_t(width_);
  const float* values = &estimate.pixels.data()->x;  // a colour is three floats
  const SumPointers first{h.sums.high(), h.sums.low(), squares_.high(), squares_.low()};
  std::vector<BandSums> bands(std::size_t((height_ + rows_of_band - 1) / rows_of_band));
  const auto add_band = [&](int b) {
    BandSums band;
    const int end = std::min(height_, (b + 1) * rows_of_band);
    for (int y = b * rows_of_band; y < end; ++y) {
      const std::size_t at = std::size_t(y) * row;
      band.add_row(values + at, row, y, first + at, shares);
    }
    bands[std::size_t(b)] = band;
  };
  const int n = static_cast<int>(bands.size());
  if (pool != nullptr) {
    pool->for_each(n, add_band);
  } else {
    for (int b = 0; b < n; ++b) add_band(b);
  }
  SquaredErrors::Sums sums{};
  for (const BandSums& band : bands) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += band.sums[k] / 3;  // channels
    exact_ = exact_ && std::ranges::all_of(band.lost, [](double v) { return v == 0; });
  }
  if (h.n >= 2) squared_errors_.add(sums, width_, height_);
}

void Film::merge(const Film& other) {
  if (other.width_ != width_ || other.height_ != height_) {
    throw std::invalid_argument("the two films have different sizes");
  }
  for (std::size_t k = 0; k < halves_.size(); ++k) {
    halves_[k].n += other.halves_[k].n;
    exact_ = halves_[k].sums.add(other.halves_[k].sums) && exact_;
  }
  exact_ = exact_ && other.exact_;
  squares_.add(other.squares_);
  squared_errors_.merge(other.squared_errors_);
}

PairSum Film::sum(std::size_t i) const {
  PairSum sum = halves_[0].sums[i];
  add_to(sum, halves_[1].sums[i]);
  return sum;
}

std::vector<double> Film::mean() const {
  std::vector<double> mean(squares_.size());
  const auto n = static_cast<double>(std::max<std::uint64_t>(1, iterations()));
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = sum(i).high / n;
  return mean;
}

std::vector<double> Film::half_mean(int half) const {
  const Half& h = halves_[std::size_t(half)];
  std::vector<double> mean(squares_.size());
  const auto n = static_cast<double>(std::max<std::uint64_t>(1, h.n));
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = h.sums[i].high / n;
  return mean;
}

std::vector<double> Film::variance_of_mean() const {
  std::vector<double> variance(squares_.size(), 0.0);
  const auto n = static_cast<double>(iterations());
  if (n < 2) return variance;
  for (std::size_t i = 0; i < variance.size(); ++i) {
    variance[i] = scaled_deviations(n, squares_[i], sum(i)) / n / (n - 1) / n;
  }
  return variance;
}

std::vector<double> Film::variance_from_halves() const {
  std::vector<double> variance(squares_.size(), 0.0);
  if (halves_[0].n == 0 || halves_[1].n == 0) return variance;
  const auto even = static_cast<double>(halves_[0].n), odd = static_cast<double>(halves_[1].n);
  for (std::size_t i = 0; i < variance.size(); ++i) {
    const double apart = halves_[0].sums[i].high / even - halves_[1].sums[i].high / odd;
    variance[i] = apart * apart * scale_from_halves(even, odd);
  }
  return variance;
}

void Film::save(ByteWriter& out) const {
  out.put(width_);
  out.put(height_);
  for (const Half& h : halves_) {
    out.put(h.n);
    h.sums.save(out);
  }
  squares_.save(out);
  out.put(static_cast<std::uint8_t>(exact_));
  squared_errors_.save(out);
}

void Film::load(ByteReader& in) {
  if (in.get<int>() != width_ || in.get<int>() != height_) {
    throw std::runtime_error("saved film has another size");
  }
  for (Half& h : halves_) {
    h.n = in.get<std::uint64_t>();
    h.sums.load(in, "film");
  }
  squares_.load(in, "film");
  const auto exact = in.get<std::uint8_t>();
  if (exact > 1) throw std::runtime_error("saved film has a flag that is neither 0 nor 1");
  exact_ = exact == 1;
  squared_errors_.load(in);
}

}  // namespace lacuna
